#!/usr/bin/env bash
# finds_planted.sh AR ARCHIVE OBJECT COMMAND...: COMMAND, which finds nothing in ARCHIVE, does once OBJECT is in it.
set -euo pipefail
ar=$1 archive=$2 object=$3
shift 3

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
cp "$archive" "$folder/planted.a"
"$ar" q "$folder/planted.a" "$object"
status=0
"$@" "$folder/planted.a" || status=$?
((status == 1)) || {
    echo "what $object holds was not found (exit status $status)" >&2
    exit 1
}
