#!/usr/bin/env bash
# Installs Alhazen into a folder of its own, builds the example project against it and has it checked, which must find
# it wrong: install.sh BUILD EXAMPLE WORK
set -euo pipefail
build=$1 example=$2 work=$3
rm -rf "$work"
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -S "$example" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
cmake --build "$work/build" >/dev/null
status=0
"$work/prefix/bin/alhazen" crosscheck --rays 2048 --intersector "$(find "$work/build" -name 'libnaive_sphere.so')" || status=$?
[ "$status" = 5 ] || { echo "expected status 5, got $status"; exit 1; }
printf '{"asset": {"version": "2.0"}}' >"$work/empty.gltf"
"$work/prefix/bin/alhazen" render "$work/empty.gltf" -o "$work/empty.jpg" --size 8x8 --quiet
rm "$(find "$work/prefix" -name alhazen_images.so)"
status=0
"$work/prefix/bin/alhazen" render "$work/empty.gltf" -o "$work/empty.jpg" --size 8x8 --quiet 2>"$work/said" || status=$?
[ "$status" = 1 ] && grep -q 'cannot load what reads and writes images' "$work/said" ||
  { echo "status $status, without its library it said:"; cat "$work/said"; exit 1; }
status=0
"$work/build/check_naive_sphere" || status=$?
[ "$status" = 5 ] || { echo "expected status 5, got $status"; exit 1; }
