# shellcheck shell=bash
# To be sourced: what MPI and threads need to behave in containers and on small machines, unless it is set already.

# Open MPI refuses to run as root, which is what one is in a container, and more ranks than cores.
export OMPI_ALLOW_RUN_AS_ROOT="${OMPI_ALLOW_RUN_AS_ROOT-1}"
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="${OMPI_ALLOW_RUN_AS_ROOT_CONFIRM-1}"
export OMPI_MCA_rmaps_base_oversubscribe="${OMPI_MCA_rmaps_base_oversubscribe-1}"
export PRTE_MCA_mapby="${PRTE_MCA_mapby-:oversubscribe}" # Open MPI 6; it would warn of the name in 5
if [[ $(mpirun --version 2>/dev/null) == *"(Open MPI) 5."* ]]; then
  export PRTE_MCA_rmaps_default_mapping_policy="${PRTE_MCA_rmaps_default_mapping_policy-:oversubscribe}"
fi
# Containers often forbid the system call that copies between processes: an error message for each large MPI message.
export OMPI_MCA_btl_vader_single_copy_mechanism="${OMPI_MCA_btl_vader_single_copy_mechanism-none}"
export OMPI_MCA_smsc="${OMPI_MCA_smsc-^cma}" # its name since Open MPI 5
# Open MPI 5 asks the kernel's routing table which ranks can meet, and complains about itself where there is IPv6.
export OMPI_MCA_reachable="${OMPI_MCA_reachable-weighted}"
export OMPI_MCA_btl_base_warn_component_unused="${OMPI_MCA_btl_base_warn_component_unused-0}"
# All parallelism is in the ranks.
export OMP_NUM_THREADS="${OMP_NUM_THREADS-1}"
export DEAL_II_NUM_THREADS="${DEAL_II_NUM_THREADS-1}"

# Cores this process may use. Left to itself, nproc would answer OMP_NUM_THREADS.
BILLET_CORES=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc 2>/dev/null || echo 1)
export BILLET_CORES

# Jobs of a parallel build: one per core, and 2 GB of memory for each, as deal.II's headers need.
billet_jobs() {
  local memory limit jobs
  memory=$(awk '/^MemTotal:/ { print int($2 / 1024) }' /proc/meminfo 2>/dev/null)
  memory=${memory:-2000}
  for limit in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
    # A container's own limit, in bytes; "max" or something with 19 digits if there is none.
    [[ -r $limit && $(<"$limit") =~ ^[0-9]{1,15}$ ]] || continue
    limit=$(($(<"$limit") / 1000000))
    ((limit >= memory)) || memory=$limit
  done
  jobs=$((memory / 2000))
  ((jobs <= BILLET_CORES)) || jobs=$BILLET_CORES
  ((jobs >= 1)) || jobs=1
  echo "$jobs"
}
export BILLET_JOBS="${BILLET_JOBS-$(billet_jobs)}"
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL-$BILLET_JOBS}"
