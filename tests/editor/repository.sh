#!/usr/bin/env bash
# The hooks of .pre-commit-hooks.yaml and the step of action.yml on a small repository of good and bad files.
#
#     repository.sh ROOT ODKIT FOLDER    ROOT is this project, FOLDER is made again; needs git and pre-commit
set -euo pipefail
root=$1 odkit=$2 folder=$3

fail() {
  echo "repository.sh: $1" >&2
  exit 1
}

rm -rf "$folder"
mkdir -p "$folder/devices" "$folder/bin"
ln -s "$odkit" "$folder/bin/odkit"
export PATH="$folder/bin:$PATH"
cd "$folder"
sed 's/DataType:/DataType=/; s/^DefaultValue=300$/DefaultValue=30/' "$root/tests/editor/thermometer.eds" >devices/good.eds
cp "$root/tests/editor/thermometer.eds" devices/bad.eds
echo text >notes.txt
git init -q
git add devices notes.txt

# The hook of a project: its definition is that of the file in the root, with names of files behind it.
cat >.pre-commit-config.yaml <<CONFIG
repos:
  - repo: local
    hooks:
$(sed -n '/^- id/,$p' "$root/.pre-commit-hooks.yaml" | sed 's/^/      /')
CONFIG
out=$(pre-commit run odkit-check --files devices/good.eds notes.txt 2>&1) || fail "a good file is rejected: $out"
out=$(pre-commit run odkit-check --all-files 2>&1) && fail "a bad file is accepted: $out"
grep -q 'error\[E0412\]' <<<"$out" || fail "the error is not shown: $out"
grep -q 'notes.txt' <<<"$out" && fail "a file of another kind is checked: $out"
out=$(pre-commit run odkit-fix --all-files 2>&1) && fail "a fix is not reported as a change: $out"
grep -q '^DataType=0x0006$' devices/bad.eds || fail "the file is not fixed"
git checkout -q devices/bad.eds

# The step of the action.
export ODKIT=odkit ODKIT_SARIF="$folder/odkit.sarif" GITHUB_OUTPUT="$folder/output"
ODKIT_FILES=devices/good.eds "$root/editors/action.sh" >annotations || fail "a good file fails the step"
out=$(ODKIT_FILES=$'devices/good.eds\r\n\ndevices/bad.eds\n' "$root/editors/action.sh") && fail "a bad file passes the step"
grep -q '^::error file=devices/bad.eds,line=158,' <<<"$out" || fail "the annotation is missing: $out"
grep -q 'file=devices/good.eds.*::error' <<<"$out" && fail "a good file has an error: $out"
grep -q "^sarif=$folder/odkit.sarif$" output || fail "the output is missing"
grep -q '"ruleId": "E0412"' odkit.sarif || fail "the finding is not in the SARIF file"
ODKIT_FILES=devices/good.eds ODKIT_ARGS=--strict "$root/editors/action.sh" >annotations && fail "--strict is not passed on"
echo "hooks and action work"
