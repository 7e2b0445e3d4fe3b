#!/bin/sh
# pkg_config.sh shared|static LIBDIR WORKDIR: builds first_hit.c with pkg-config's flags against the library in LIBDIR, and runs it.
set -eu
linkage=$1 libdir=$2 work=$3
export PKG_CONFIG_PATH="$libdir/pkgconfig"
mkdir -p "$work"

case $linkage in
    shared) libs="$($PKG_CONFIG --libs gnomon) -Wl,-rpath,$libdir" ;;
    static) libs=$($PKG_CONFIG --static --libs gnomon | sed 's/-lgnomon/-l:libgnomon.a/') ;;
esac
# shellcheck disable=SC2046,SC2086  # flags are words
"$CC" -std=c99 "$(dirname "$0")/first_hit.c" $($PKG_CONFIG --cflags gnomon) $libs -o "$work/first_hit"
"$work/first_hit"
