#!/bin/sh
# Make the virtual environment with the first tool that can; say what to install where none can.
set -eu
target=$1
python=${PYTHON:-python3}

if ! command -v "$python" >/dev/null 2>&1; then
    echo "make: there is no $python. Install Python 3.11 or newer (Debian: apt-get install python3 python3-venv)." >&2
    exit 2
fi
if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
    echo "make: $python is $("$python" -V 2>&1), Atoll needs 3.11 or newer; name one with 'make PYTHON=python3.12 ...'." >&2
    exit 2
fi
if "$python" -m venv "$target" >/dev/null 2>&1; then
    exit 0
fi
rm -rf "$target"
if command -v virtualenv >/dev/null 2>&1; then
    exec virtualenv --quiet --python "$python" "$target"
fi
if command -v uv >/dev/null 2>&1; then
    exec uv venv --quiet --seed --python "$python" "$target"
fi
echo "make: $python cannot make a virtual environment. Install one of: python3-venv (Debian: apt-get install" \
    "python3-venv), virtualenv, uv; then run make again." >&2
exit 2
