#!/usr/bin/env bash
# Makes what is published: a source distribution, and wheels for Linux that run wherever glibc is 2.28 or later.
#
#   ./wheels.sh OUT [TARGET…]     targets such as x86_64-unknown-linux-gnu, the default, and aarch64-unknown-linux-gnu
#
# Zig links against the old glibc, so no container is needed; a target's standard library comes by rustup. It fails where a
# licence is missing, a wheel names a folder of this machine, or the source distribution describes itself otherwise than here.
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

# Puts the licences of a build for a target where pyproject.toml takes them from.
put_licences() {
    mkdir -p licences
    cp ../LICENSE-APACHE ../LICENSE-MIT licences
    ../.ci/licences python/Cargo.toml "$1" >licences/LICENSE-CRATES
}

# Fails where a list of names, from standard input, lacks a licence.
check_licences() {
    local names file
    names=$(cat)
    for file in licences/*; do
        grep -qF "/$file" <<<"$names" || { echo "$1 lacks $file" >&2; exit 1; }
    done
}

# Writes the metadata of a project's folder.
describe() {
    (cd "$1" && maturin pep517 write-dist-info --metadata-directory "$2" --interpreter python)
}

put_licences "$1"
maturin sdist --out "$environment/sdist"
archive=$(echo "$environment"/sdist/*.tar.gz)
tar -tzf "$archive" | check_licences "$(basename "$archive")"
mkdir "$environment/source"
tar -xzf "$archive" -C "$environment/source" --strip-components 1
describe . "$environment/here"
describe "$environment/source" "$environment/there"
diff -r "$environment/here" "$environment/there"

# A panic names the place in the sources, from their own folder on.
crates=${CARGO_HOME:-$HOME/.cargo}/registry/src
sources=$(realpath ..)
export RUSTFLAGS="${RUSTFLAGS:-} --remap-path-prefix=$crates=crates --remap-path-prefix=$sources=bounce-audio"
for target in "$@"; do
    put_licences "$target"
    maturin build --release --compression-level 9 --zig --target "$target" --compatibility manylinux_2_28 --out "$environment/wheels"
done
for wheel in "$environment"/wheels/*.whl; do
    python -m zipfile --list "$wheel" | check_licences "$(basename "$wheel")"
    python -m zipfile --extract "$wheel" "$environment/$(basename "$wheel" .whl)"
    if grep -rlF -e "$crates" -e "$sources" "$environment/$(basename "$wheel" .whl)"; then
        echo "$(basename "$wheel") names a folder of this machine" >&2
        exit 1
    fi
done

mkdir -p "$out"
mv "$archive" "$environment"/wheels/*.whl "$out"
ls -l "$out"
