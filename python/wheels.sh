#!/usr/bin/env bash
# Makes what is published: a source distribution, and wheels for Linux that run wherever glibc is 2.28 or later.
#
#   ./wheels.sh OUT [TARGET…]     targets such as x86_64-unknown-linux-gnu, the default, and aarch64-unknown-linux-gnu
#
# Zig links against the old glibc, so no container is needed; a target's standard library comes by rustup.
set -euo pipefail
cd "$(dirname "$0")"
out=$(realpath -m "${1:?where to put them}")
shift
[ $# -gt 0 ] || set -- x86_64-unknown-linux-gnu

environment=$(mktemp -d)
trap 'rm -rf "$environment"' EXIT
python3 -m venv "$environment"
PATH="$environment/bin:$PATH"
pip install --quiet 'maturin[zig]>=1.9.4,<2'

maturin sdist --out "$out"
for target in "$@"; do
    maturin build --release --compression-level 9 --zig --target "$target" --compatibility manylinux_2_28 --out "$out"
done
ls -l "$out"
