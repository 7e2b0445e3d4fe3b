#!/bin/sh
# debian-packages.sh compare|report|test: installs the Debian packages that `make compare` and the like need and lack.
# Quick when nothing is missing. Without root or a password-less sudo it prints the one line to type, and fails.
set -eu

required="cmake g++ make pkg-config libtinygltf-dev nlohmann-json3-dev libcli11-dev libstb-dev libopenexr-dev libgmp-dev doctest-dev libjs-chart.js assimp-testmodels python3"
optional="libembree-dev"
case $1 in
report)
    required="$required python3-matplotlib"
    ;;
test)
    required="$required clang-format"
    optional="$optional valgrind clang python3-matplotlib"
    ;;
esac

missing_of() {
    for package in "$@"; do
        state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$state" = installed ] || printf '%s ' "$package"
    done
}

if ! command -v dpkg-query >/dev/null; then
    echo "not a Debian system: if the build stops, install what these Debian packages hold: $required $optional"
    exit 0
fi
# shellcheck disable=SC2086  # lists of words, here and below
missing_required=$(missing_of $required)
# shellcheck disable=SC2086
missing_optional=$(missing_of $optional)
[ -n "$missing_required$missing_optional" ] || exit 0

if [ "$(id -u)" = 0 ]; then
    as_root="env"
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root="sudo env"
elif [ -n "$missing_required" ]; then
    echo "packages are missing; type this, then run make again:"
    echo "    sudo apt-get install $missing_required$missing_optional"
    exit 1
else
    echo "going on without: $missing_optional(sudo apt-get install $missing_optional)"
    exit 0
fi

install() {
    $as_root DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@"
}
# A fresh machine has no package lists yet, an old one lists that name files long gone.
$as_root apt-get update --quiet || echo "apt-get update failed: going on with the package lists at hand"
# shellcheck disable=SC2086
[ -z "$missing_required" ] || install $missing_required
for package in $missing_optional; do
    install "$package" || echo "going on without $package, which could not be installed"
done
