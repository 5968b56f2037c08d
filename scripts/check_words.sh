#!/usr/bin/env bash
# Settings are words only where people read and write them: in src/cli and in the loaders of scene files. Everywhere else
# they are values. Prints the lines that compare a setting, or a figure's label, with a word, and fails if there are any.
set -uo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." || exit 1

mapfile -t below_the_edge < <(git ls-files 'src/*.h' 'src/*.cpp' | grep -vE '^src/(cli|mpi|scene/load)/')
settings='(method|plan|coverage|filter|power|paths|mis|builder|failures)'
status=0
forbid() { # WHAT, REGULAR EXPRESSION
    local found
    found=$(grep -snE -- "$2" "${below_the_edge[@]}")
    if [ -n "$found" ]; then
        printf '%s:\n%s\n' "$1" "$found"
        status=1
    fi
}
forbid 'a setting is compared with a word' "\b$settings(_|\(\)|(->|\.)name)? *[!=]= *\""
forbid 'a setting is compared with a word' "\" *[!=]= *[A-Za-z_.>-]*\b$settings\b"
forbid 'a method is looked up by its name' 'method_named *\( *"'
forbid 'a setting holds a word' "std::string(_view)? $settings(_)? *="
forbid 'a figure is looked up by its label' 'values\.(find|at|contains|count|erase) *\('
forbid 'a stage is told by its name' 'stage(->|\.)name *[!=]='
exit $status
