#!/bin/sh
# Linker for win64: leaves only fmi2* in the compiler's list of exports. Windows has no version script,
# and a crate below exports functions of its own. The list comes as `-Wl,FOLDER/list.def`.
set -e
for argument in "$@"; do
    case $argument in
        *.def) sed -i -E '/^(EXPORTS|LIBRARY)/b; /^ *"?fmi2/b; d' "${argument#-Wl,}" ;;
    esac
done
exec x86_64-w64-mingw32-gcc "$@"
