#!/bin/sh
# symbols.sh NM LIBRARY LIST: the library's exported symbols are those of LIST, and no others.
set -eu
actual=$("$1" --dynamic --defined-only --format=posix "$2" | cut -d ' ' -f 1 | LC_ALL=C sort)
expected=$(LC_ALL=C sort "$3")
if [ "$actual" != "$expected" ]; then
    echo "exported symbols of $2 differ from $3 (< only in the library, > only in the list):"
    work=$(mktemp -d)
    trap 'rm -r "$work"' EXIT
    echo "$actual" >"$work/actual"
    echo "$expected" | diff "$work/actual" - || true
    exit 1
fi
