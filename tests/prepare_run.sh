# shellcheck shell=bash disable=SC2154
# Sourced by run_*.sh with $tests, $folder and the command in "$@": a fresh current folder and MPI's environment.
# shellcheck source=scripts/environment.sh
. "$tests/../scripts/environment.sh"
# Open MPI binds ranks to cores from the first one on: two tests at a time would share it and leave others idle.
export OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_bindto=none # up to Open MPI 5, from 6 on

for word in "$@"; do
  [[ $word != */bin/* || -x $word ]] || { echo "$word is not built: build the target test_programs" && exit 1; }
done
rm -rf -- "$folder"
mkdir -p -- "$folder"
cd -- "$folder" || exit 1
