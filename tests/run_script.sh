#!/usr/bin/env bash
# What ./run promises, tried on a copy of it among stand-ins for the package manager and the build: run_script.sh RUN
set -u
run=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export WORK=$work
failed=0
complain() {
  echo "FAILED: $*"
  [ ! -s "$work/err" ] || sed 's/^/    /' "$work/err"
  failed=1
}

# A checkout, and a PATH that holds nothing but these tools and the stand-ins.
checkout="$work/check out" tools=$work/tools
mkdir -p "$checkout" "$tools"
cp "$run" "$checkout/run"
printf '# a comment\nlibalpha-dev\nlibbeta-dev\n' >"$checkout/packages.txt"
for tool in bash cat comm dirname env flock grep ln mkdir nproc readlink rmdir sed sleep sort touch; do
  ln -s "$(command -v "$tool")" "$tools/$tool"
done
stand_in() {
  { echo '#!/usr/bin/env bash'; cat; } >"$tools/$1"
  chmod +x "$tools/$1"
}
here() { PATH=$tools "$@" >"$work/out" 2>"$work/err"; }

stand_in id <<<'echo 1000'
stand_in sudo <<<'touch "$WORK/as-root"; exec "$@"'
stand_in apt-get <<<'echo "$*" >>"$WORK/apt"; case $* in install*) touch "$WORK/installed" ;; esac'
stand_in dpkg-query <<<'[ ! -e "$WORK/beta-is-missing" ] || [ -e "$WORK/installed" ] || set -- libalpha-dev
printf "installed %s\n" "${@: -2}"'
stand_in ninja <<<'[ ! -e "$2/up-to-date" ] || echo "ninja: no work to do."'
stand_in cmake <<'STAND_IN'
mkdir "$WORK/building" || touch "$WORK/two-builds"
sleep 0.3
rmdir "$WORK/building"
[ ! -e "$WORK/broken" ] || { echo 'error: no such type'; exit 1; }
echo "$*" >>"$WORK/cmake"
mkdir -p build/release/apps
case $* in
  *--build*) ln -sf "$WORK/tools/program" build/release/apps/alhazen; touch build/release/up-to-date ;;
  *) touch build/release/build.ninja ;;
esac
STAND_IN
# Prints its folder and its arguments, and exits with 7.
stand_in program <<<'pwd; printf "[%s]" "$@"; exit 7'

# A package is missing: --no-install names the command and touches nothing.
touch "$work/beta-is-missing"
here "$checkout/run" --no-install info scene.gltf && complain '--no-install succeeds though a package is missing'
grep -q 'sudo apt-get install .*libbeta-dev' "$work/err" || complain '--no-install does not print the command'
grep -q libalpha-dev "$work/err" && complain '--no-install asks for a package that is there'
[ -s "$work/out" ] && complain '--no-install prints to stdout'
[ -e "$work/apt" ] || [ -e "$work/cmake" ] && complain '--no-install installs or builds'
rm "$work/beta-is-missing"

# Two at once: one builds, the other waits, both run.
(PATH=$tools "$checkout/run" a >/dev/null 2>&1; echo $? >"$work/first") &
here "$checkout/run" a
[ $? = 7 ] || complain 'the second of two at once fails'
wait $!
[ "$(cat "$work/first")" = 7 ] || complain 'the first of two at once fails'
[ -e "$work/two-builds" ] && complain 'two builds ran at once'
[ "$(wc -l <"$work/cmake")" = 2 ] || complain 'configured or built more than once'
[ -e "$work/apt" ] && complain 'apt-get was called though nothing is missing'

# Nothing to do: the program's output and exit status, in the caller's folder, arguments as they are; by a symlink too.
ln -s "$checkout/run" "$work/link"
mkdir "$work/elsewhere"
for script in "$checkout/run" ../link; do
  (cd "$work/elsewhere" && here "$script" render 'a b.gltf' '' -o '*')
  [ $? = 7 ] || complain "$script: the exit status is lost"
  [ -s "$work/err" ] && complain "$script: something is printed though nothing was done"
  [ "$(cat "$work/out")" = "$work/elsewhere"$'\n''[render][a b.gltf][][-o][*]' ] ||
    complain "$script: the folder or the arguments differ: $(cat "$work/out")"
done
[ "$(wc -l <"$work/cmake")" = 2 ] || complain 'built again though nothing changed'

# A build that fails shows what the compiler said and says what to do.
rm "$checkout/build/release/up-to-date"
touch "$work/broken"
here "$checkout/run" info && complain 'a failed build is not a failure'
grep -q 'no such type' "$work/err" && grep -q 'run this again' "$work/err" ||
  complain 'a failed build does not say what to do'
rm "$work/broken"

# A package is missing: it alone is installed, as root, and that is said.
touch "$work/beta-is-missing"
here "$checkout/run" info
[ $? = 7 ] || complain 'after installing, the program does not run'
grep -q 'installing libbeta-dev$' "$work/err" || complain 'it does not say what it installs'
grep -q '^install .*libbeta-dev$' "$work/apt" || complain 'the package is not installed'
grep -q libalpha-dev "$work/apt" && complain 'a package is installed that was there'
[ -e "$work/as-root" ] || complain 'sudo is not used by a user'

# Where there is no dpkg, it goes on.
rm "$tools/dpkg-query" "$work/apt"
here "$checkout/run" --no-install info
[ $? = 7 ] || complain 'without dpkg it does not run'
[ -e "$work/apt" ] && complain 'apt-get was called where there is no dpkg'
exit $failed
