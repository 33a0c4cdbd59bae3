#!/usr/bin/env bash
# Usage: packages.sh GROUP...     Installs packages of these groups that are missing (Debian, Ubuntu)
#
#   build       compile, run and test billet
#   trade       run billet-trade and billet-fit, and their tests
#   benchmarks  compare with CalculiX, billet-trade included
#   python      format and check the Python of the repository
#   spelling    check the spelling of texts and the format of code
#   pictures    draw the manual's pictures with ParaView, without a display
#   documentation  build the site of the documentation, and check its looks
#   package     make and try a package for Debian
#
# BILLET_SKIP_PACKAGES=1 leaves the system alone, as on a cluster with modules. DEAL_II_DIR names an
# own deal.II, which libdeal.ii-dev would only shadow.
set -euo pipefail

case ${1:-} in
  -h | --help)
    sed -n '2,14s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
    exit 0
    ;;
esac

if [[ ${BILLET_SKIP_PACKAGES:-0} != 0 ]]; then
  exit 0
fi

packages=()
for group in "$@"; do
  case $group in
    build)
      # libdeal.ii-dev brings Trilinos, METIS, HDF5 and MUMPS with it, but recommends its compiler only.
      # libopenblas0-serial: the default BLAS is the reference one, four times slower in a factorisation.
      packages+=(g++ cmake ninja-build ccache lld git openmpi-bin libmumps-dev libopenblas0-serial
        nlohmann-json3-dev numdiff python3 universal-ctags gfortran)
      [[ -n ${DEAL_II_DIR:-} ]] || packages+=(libdeal.ii-dev)
      ;;
    trade) packages+=(python3 python3-matplotlib python3-paraview python3-scipy) ;;
    benchmarks)
      packages+=(calculix-ccx calculix-ccx-test gmsh valgrind python3 python3-matplotlib python3-meshio python3-paraview)
      ;;
    python) packages+=(black flake8 mypy python3-numpy python3-yaml) ;;
    spelling) packages+=(codespell clang-format-14) ;;
    pictures) packages+=(paraview python3-paraview python3-pil xvfb xauth) ;; # pvpython wants a display: xvfb-run, which wants xauth
    documentation)
      packages+=(python3-sphinx python3-myst-parser furo python3-sphinxcontrib.bibtex python3-sphinx-argparse
        python3-breathe libjs-katex chromium doxygen python3-numpy python3-matplotlib)
      ;;
    package) packages+=(lintian mmdebstrap dpkg-dev) ;;
    *)
      echo "packages.sh: unknown group '$group' (build, trade, benchmarks, python, spelling, pictures, documentation, package)" >&2
      exit 2
      ;;
  esac
done

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "packages.sh: no apt-get here, so nothing is installed. By their Debian names, this is needed:" >&2
  echo "  ${packages[*]}" >&2
  echo "Going on with what there is." >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  # shellcheck disable=SC2016 # dpkg's own variable
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed* ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

if ((EUID == 0)); then
  as_root=()
elif command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; then
  as_root=(sudo)
else
  echo "packages.sh: missing packages, and neither root nor sudo to install them. An administrator must run" >&2
  echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

echo "Installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q)
# An old list may do as well: the installation tells.
"${apt[@]}" update || echo "packages.sh: apt-get update failed; trying with the lists there are" >&2
"${apt[@]}" install --yes --no-install-recommends "${missing[@]}"
