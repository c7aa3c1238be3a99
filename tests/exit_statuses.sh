#!/usr/bin/env bash
# The exit status of every kind of failure: exit_statuses.sh PROGRAM SCENE
set -u
program=$1 scene=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
expect() {
  local status=$1
  shift
  "$program" "$@" >"$work/log" 2>&1
  local got=$?
  if [ "$got" != "$status" ]; then
    echo "expected $status, got $got: $*"
    cat "$work/log"
    failed=1
  fi
}
echo '{"asset":{"version":"2.0"},"extensionsUsed":["X_y"],"extensionsRequired":["X_y"]}' >"$work/required.gltf"
echo '{"asset":{"version":"2.0"' >"$work/truncated.gltf"
expect 0 render "$scene" -o "$work/a.exr" --size 16x9 --quiet
expect 0 render "$scene" -o "$work/s.exr" --size 16x9 --integrator signature --quiet
expect 0 info "$scene"
expect 0 --version
expect 0 render --help
expect 2 render "$scene" --no-such-option
expect 2 render "$scene" -o "$work/a.exr" --camera nobody
expect 3 render "$work/absent.gltf" -o "$work/a.png"
expect 3 render "$work/truncated.gltf" -o "$work/a.png"
expect 3 render "$work/required.gltf" -o "$work/a.png"
expect 4 render "$scene" -o "$work/absent/a.png"
# A signal stops at the next cell and saves what is finished.
for signal in INT:130 TERM:143; do
  "$program" render "$scene" -o "$work/partial.exr" --spp 4096 --quiet >"$work/log" 2>&1 &
  sleep 1
  kill -"${signal%:*}" $!
  wait $!
  got=$?
  if [ "$got" != "${signal#*:}" ] || [ ! -s "$work/partial.exr" ]; then
    echo "SIG${signal%:*}: status $got, or no picture"
    failed=1
  fi
  rm -f "$work/partial.exr"
done
[ -z "$(find "$work" -name '*.part*')" ] || { echo 'a temporary file was left behind'; failed=1; }
exit $failed
