#!/usr/bin/env bash
# Usage: run_comparison.sh FOLDER COMPARISON_FILE NUMDIFF DEAL_II_SCRIPTS COMMAND...
#
# Runs COMMAND in a fresh FOLDER and compares the file `output` that it writes there, or else all that it prints, with
# COMPARISON_FILE or one of its variants (COMPARISON_FILE.*), by deal.II's rules: numbers to 1e-8 relative or 1e-6.
# With UPDATE_OUTPUT=1 in the environment the result becomes the new COMPARISON_FILE.
set -u
folder=$1 comparison_file=$2 numdiff=$3 dealii_scripts=$4
shift 4
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/prepare_run.sh
. "$tests/prepare_run.sh"

"$@" >stdout 2>&1 </dev/null
code=$?
if ((code != 0)); then
  echo "exit code $code from: $*"
  cat stdout
  [[ ! -f output ]] || { echo "--- output so far:" && cat output; }
  exit 1
fi
[[ $comparison_file != *.run_only ]] || exit 0

[[ -f output ]] || mv stdout output
perl -pi "$dealii_scripts/normalize.pl" output
perl -pi -e 's/^Completed in \d+:\d+/Completed in 0:00/' output # what is timed is never compared
perl -pi -e 's/ elements in \S+ s: \S+ ns for each element and step, \S+ of/ elements in 0 s: 0 ns for each element and step, 0 of/' output
[[ ${UPDATE_OUTPUT:-0} == 0 ]] || cp output "$comparison_file"
sh "$dealii_scripts/run_test.sh" diff "$(basename "$folder")" "$numdiff" "$comparison_file"
