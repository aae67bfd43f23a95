#!/bin/sh
# Write requirements.lock (what a run needs) and requirements-dev.lock (what tests need on top): versions and hashes,
# no addresses. requirements-peers.lock is what the peers of a benchmark need, on Linux alone.
set -eu
compile() {
    .venv/bin/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
        --no-emit-find-links --no-header --no-annotate "$@"
}
compile pyproject.toml --group lock --output-file requirements.lock
compile --group dev --constraints requirements.lock --output-file requirements-dev.lock
.venv/bin/uv pip compile --quiet --python-platform linux --python-version 3.11 --generate-hashes --no-emit-index-url \
    --no-emit-find-links --no-header --no-annotate --group peers --output-file requirements-peers.lock
