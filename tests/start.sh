#!/usr/bin/env bash
# What takes long to load is loaded only where it is needed: start.sh PROGRAM WORK
set -euo pipefail
program=$1 work=$2/start
mkdir -p "$work"
printf '{"asset": {"version": "2.0"}}' >"$work/empty.gltf"

loads_images() { LD_DEBUG=libs "$program" "$@" 2>&1 >/dev/null | grep -c alhazen_images >/dev/null; }
fail() { echo "$1"; exit 1; }

cd "$work"
for arguments in '--version' 'info empty.gltf' 'render empty.gltf -o out.exr --size 16x9' 'render empty.gltf -o out.png --size 16x9'; do
  # shellcheck disable=SC2086
  ! loads_images $arguments || fail "'alhazen $arguments' loads what it does not need"
done
loads_images render empty.gltf -o out.jpg --size 16x9 || fail 'what writes .jpg is loaded in a way that this test does not see'
