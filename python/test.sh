#!/usr/bin/env bash
# Builds the package, installs it into a fresh environment and passes all its tests: ./test.sh [PYTHON]
set -euo pipefail
cd "$(dirname "$0")"
python=${1:-python3}

environment=$(mktemp -d)
trap 'rm -rf "$environment"' EXIT
"$python" -m venv "$environment"
PATH="$environment/bin:$PATH"

cargo fmt --check
cargo clippy --release -- -D warnings
pip install --quiet 'maturin>=1.9.4,<2'
maturin build --release --compression-level 9 --interpreter python --out "$environment/wheels"
wheel=$(echo "$environment"/wheels/*.whl)
size=$(stat -c %s "$wheel")
echo "$(basename "$wheel"): $size bytes"
if [ "$size" -gt 2097152 ]; then
    echo "the wheel is larger than 2 MiB" >&2
    exit 1
fi
pip install --quiet "$wheel[test]"

# The command to compare with.
cargo build --release --manifest-path ../Cargo.toml
BOUNCE_AUDIO_COMMAND=$(realpath "${CARGO_TARGET_DIR:-../target}/release/bounce-audio")
export BOUNCE_AUDIO_COMMAND

# Of its examples, those of the README first: they are what a newcomer tries.
pytest --quiet --doctest-glob=README.md README.md
pytest --quiet --doctest-modules --pyargs bounce_audio
pytest --quiet tests
mypy --strict -p bounce_audio
python -m mypy.stubtest --mypy-config-file pyproject.toml bounce_audio
