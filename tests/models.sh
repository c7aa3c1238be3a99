#!/usr/bin/env bash
# Renders every model of a folder: models.sh PROGRAM FOLDER. What is in FOLDER/broken may be refused, never crash or take
# long; everything else renders without a warning about itself, unless it requires an extension that is not supported.
# Status 77: there is no such folder.
set -u
program=$1 folder=$2
[ -d "$folder" ] || { echo "skipped: there is no $folder"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Prints one line: what became of the model, its name, and why it failed.
try_model() {
  local model=$1 log status
  log=$(mktemp -p "$work")
  (ulimit -t 5 && timeout 120 "$program" render "$model" -o "$log.exr" --size 16x9 --threads 1 --quiet) >"$log" 2>&1
  status=$?
  rm -f "$log.exr"
  # Left out on purpose: optional extensions, points and lines, images in formats that are not glTF's.
  local known='/extensionsUsed: ignored: |points and lines are left out|cannot decode the image.*unknown image format'
  case $status:$model in
    0:*/broken/*) echo 'broken_rendered' ;;
    3:*/broken/*) echo 'broken_refused' ;;
    0:*) if grep -qvE "$known" "$log"; then echo "failed $model: $(grep -vE "$known" "$log" | head -1)"; else echo rendered; fi ;;
    3:*) if grep -q 'requires the extension' "$log"; then echo refused; else echo "failed $model: $(head -1 "$log")"; fi ;;
    *) echo "failed $model: status $status: $(head -1 "$log")" ;;
  esac
}
export -f try_model
export program work

find "$folder" -type f \( -name '*.gltf' -o -name '*.glb' \) -print0 | sort -z |
  xargs -0 -P2 -I{} bash -c 'try_model "$1"' - {} >"$work/results"
count() { grep -c "^$1" "$work/results"; }
echo "models: $(count rendered) rendered, $(count refused) refused for a required extension;" \
  "broken: $(count broken_rendered) rendered, $(count broken_refused) refused; $(count failed) failed"
sed -n 's/^failed /  /p' "$work/results"
[ "$(count failed)" = 0 ] && [ "$(count rendered)" -gt 0 ]
