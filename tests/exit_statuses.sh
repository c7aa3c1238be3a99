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
expect 0 crosscheck "$scene" --rays 100 --size 32x18 --map "$work/map.png" --json "$work/map.jsonl"
expect 0 crosscheck --shape sphere --rays 100 --map "$work/map.png"
expect 2 crosscheck "$scene" --shape nothing
expect 2 crosscheck "$scene" --camera nobody
expect 2 crosscheck --population camera
expect 3 crosscheck "$work/truncated.gltf"
expect 3 crosscheck "$work/absent.gltf"
expect 4 crosscheck "$scene" --map "$work/absent/map.png"
expect 4 crosscheck "$scene" --map "$work/map.unheard"
expect 0 brdf "$scene" --material copper
expect 0 brdf --model phong -o "$work/lobe.svg"
expect 0 brdf --model lambert -o "$work/lobe.csv" --check
expect 0 brdf "$work/lobe.csv" --check
expect 0 brdf "$work/lobe.csv" --fit phong
expect 2 brdf "$work/lobe.csv" --fit ward
expect 2 brdf "$work/lobe.csv" --material 0
expect 3 brdf "$work/absent.csv"
expect 3 brdf "$scene.binary"
expect 5 brdf --model phong --check
expect 2 brdf "$scene" --material coper
expect 2 brdf "$scene"
expect 2 brdf --model phong --roughness 0.5
expect 2 brdf --model phonk
expect 2 brdf --model lambert --incident 90
expect 2 brdf
expect 3 brdf "$work/absent.gltf" --material 0
expect 4 brdf --model lambert -o "$work/lobe.unheard"
expect 4 brdf --model lambert -o "$work/absent/lobe.svg"
expect 2 render "$scene" --no-such-option
expect 2 render "$scene" -o "$work/a.exr" --camera nobody
expect 2 render "$scene" -o "$work/a.exr" --integrator whited
expect 2 render "$scene" -o "$work/a.jpg" --transparent
expect 2 render "$scene" -o "$work/a.png" --half
expect 2 rendr "$scene"
expect 2
expect 3 render "$work/absent.gltf" -o "$work/a.png"
expect 3 render "$work/truncated.gltf" -o "$work/a.png"
expect 3 render "$work/required.gltf" -o "$work/a.png"
expect 4 render "$scene" -o "$work/absent/a.png"
expect 4 render "$scene" -o "$work"
expect 4 render "$scene" -o "$work/a.unheard"
expect 4 render "$scene" -o "$work/a.jpg" --size 65536x1
# A signal stops at the next cell and saves what is finished: sent as soon as something is, and twice, as timeout(1) does.
for signal in INT:130 TERM:143; do
  : >"$work/log" # else the loop below reads the last run's
  "$program" render "$scene" -o "$work/partial.exr" --size 2048x2048 --spp 64 --progress json >"$work/log" 2>&1 &
  until grep -q '"fraction":[0-9.e-]*[1-9]' "$work/log" || ! kill -0 $! 2>/dev/null; do sleep 0.1; done
  kill -"${signal%:*}" $!
  kill -"${signal%:*}" $!
  wait $!
  got=$?
  if [ "$got" != "${signal#*:}" ] || [ ! -s "$work/partial.exr" ] || ! grep -q '"event":"interrupted"' "$work/log"; then
    echo "SIG${signal%:*}: status $got, or no picture"
    cat "$work/log"
    failed=1
  fi
  rm -f "$work/partial.exr"
done
[ -z "$(find "$work" -name '*.part*')" ] || { echo 'a temporary file was left behind'; failed=1; }
exit $failed
