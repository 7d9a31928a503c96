#!/usr/bin/env bash
# The step "Check" of action.yml: annotations on standard output, a SARIF file, and the exit code of `odkit check`.
#
# ODKIT is the program; ODKIT_FILES and ODKIT_ARGS have a line for each file and argument; ODKIT_SARIF is the
# file to write.
set -euo pipefail

lines() {
  # Without empty lines, and without a carriage return that a workflow may have.
  printf '%s\n' "$1" | tr -d '\r' | sed '/^[[:space:]]*$/d'
}

mapfile -t args < <(lines "${ODKIT_ARGS:-}")
mapfile -t files < <(lines "${ODKIT_FILES:-.}")

"$ODKIT" check --output-format sarif "${args[@]}" -- "${files[@]}" >"$ODKIT_SARIF" && code=0 || code=$?
if [ -s "$ODKIT_SARIF" ]; then
  echo "sarif=$ODKIT_SARIF" >>"${GITHUB_OUTPUT:-/dev/null}"
fi
if [ "${ODKIT_ANNOTATIONS:-true}" = true ]; then
  "$ODKIT" check --output-format github "${args[@]}" -- "${files[@]}" || true
fi
exit "$code"
