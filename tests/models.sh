#!/usr/bin/env bash
# Renders models: models.sh PROGRAM FOLDER whole|broken SECONDS. Of `broken`, what is in FOLDER/broken, each may be
# refused, but not crash; of `whole`, everything else, each renders without a warning about itself, unless it requires
# an extension that nobody knows. None may take more than SECONDS of processor time. Status 77: there is no such folder.
set -u
program=$1 folder=$2 kind=$3 seconds=$4
[ -d "$folder" ] || { echo "skipped: there is no $folder"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Left out on purpose: extensions, points and lines, images in formats that are not glTF's.
known='need a build with libktx|/extensionsUsed: ignored: |/extensionsRequired: requires .* which is ignored: |points and lines are left out|cannot decode the image.*unknown image format'

# Refused on purpose, as glTF wants it.
refused='/extensionsRequired/[0-9]+: requires the extension .* which is not supported'

# What is wrong with a model that ended with this status and said this: nothing, or why.
fault() {
  local status=$1 log=$2
  case $kind:$status in
    whole:0) grep -vEm1 "$known" "$log" ;;
    broken:0 | broken:3) ;;
    whole:3) grep -vEm1 "$refused" "$log" ;;
    *) echo "status $status: $(grep -Em1 'runtime error|Sanitizer' "$log" || head -1 "$log")" ;;
  esac
}

# Prints one line: what became of the model, or its name and why it failed.
try_model() {
  local model=$1 log status found
  log=$(mktemp -p "$work")
  (ulimit -t "$seconds" && timeout 300 "$program" render "$model" -o "$log.exr" --size 16x9 --threads 1 --quiet) >"$log" 2>&1
  status=$?
  rm -f "$log.exr"
  found=$(fault "$status" "$log")
  if [ -n "$found" ]; then echo "failed $model: $found"; elif [ "$status" = 0 ]; then echo rendered; else echo refused; fi
}
export -f try_model fault
export program work kind seconds known refused

if [ "$kind" = broken ]; then chosen=(-path '*/broken/*'); else chosen=(-not -path '*/broken/*'); fi
find "$folder" -type f \( -name '*.gltf' -o -name '*.glb' \) "${chosen[@]}" -print0 | sort -z |
  xargs -0 -P2 -I{} bash -c 'try_model "$1"' - {} >"$work/results"
count() { grep -c "^$1" "$work/results"; }
echo "$kind models: $(count rendered) rendered, $(count refused) refused, $(count failed) failed"
sed -n 's/^failed /  /p' "$work/results"
[ "$(count failed)" = 0 ] && [ -s "$work/results" ]
