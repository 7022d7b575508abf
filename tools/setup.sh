# Shared by ./run and ./test: installs what is missing, configures, builds. Sourced; `root` is the repository.
# shellcheck shell=sh disable=SC2034,SC2046,SC2086,SC2154,SC2209

build_dir=$root/build/release
log_dir=$root/build/log

# package:program, if the names differ.
core_programs="g++ cmake ninja-build:ninja ccache"
plot_programs="gnuplot-nox:gnuplot"
core_packages="libeigen3-dev libspectra-dev libmetis-dev libmuparser-dev libtomlplusplus-dev nlohmann-json3-dev libcli11-dev
  libfmt-dev zlib1g-dev libexpat1-dev"
mesher_packages="libcgal-dev"
viewer_programs="nodejs:node npm"
viewer_packages="libboost-dev"
case "${ASPIC_VIEWER-}" in 0 | OFF) viewer_programs='' viewer_packages='' ;; esac
test_programs="python3 chromium ffmpeg codespell $plot_programs"
test_packages="libgtest-dev libgmock-dev libbenchmark-dev libsuitesparse-dev python3-meshio python3-jsonschema"
python_packages="pybind11-dev python3-dev python3-numpy python3-scipy python3-matplotlib"
python_test_packages="python3-pytest python3-nbclient python3-nbformat python3-ipykernel python3-torch mypy"
wasm_packages="emscripten xz-utils"
mpi_packages="libpetsc-real-dev"
mpi_programs="openmpi-bin:mpirun pkg-config"
bench_packages="libbenchmark-dev"
fuzz_programs="clang:clang++" # with libFuzzer and its sanitizers, which clang recommends and we name
fuzz_packages="libclang-rt-14-dev llvm-14"

say() { printf '%s\n' "$*" >&2; }
die() {
  say "error: $*"
  exit 1
}

# Prints the packages among the arguments that are not installed.
missing_packages() {
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s ' "$package"
  done
}

# Prints the packages of the programs among the arguments that are not on the PATH.
missing_programs() {
  for entry in "$@"; do
    command -v "${entry#*:}" >/dev/null 2>&1 || printf '%s ' "${entry%:*}"
  done
}

# Runs a command with its output in a log, shown only when it fails.
logged() {
  log=$log_dir/$1.log
  shift
  mkdir -p "$log_dir"
  "$@" >"$log" 2>&1 || {
    status=$?
    tail -n 40 "$log" >&2
    say "(the whole output is in $log)"
    return $status
  }
}

# Installs the packages among the arguments; does nothing without arguments.
install_packages() {
  [ $# -gt 0 ] || return 0
  by_hand="apt-get install --no-install-recommends $*"
  command -v apt-get >/dev/null 2>&1 || die "missing: $*
These are Debian's package names; install what they contain in this system's way, then try again."
  if [ "$(id -u)" = 0 ]; then
    as_root=env
  elif command -v sudo >/dev/null 2>&1; then
    as_root="sudo env"
  else
    die "missing packages: $*
Neither root nor sudo is available to install them. Ask an administrator to run:
  $by_hand"
  fi
  say "Installing with apt-get: $*"
  logged apt-update $as_root DEBIAN_FRONTEND=noninteractive apt-get -q update ||
    say "warning: the package lists could not be refreshed (no network?); trying with the lists at hand"
  logged apt-install $as_root DEBIAN_FRONTEND=noninteractive \
    apt-get -q -y --no-install-recommends install "$@" ||
    die "the packages could not be installed. By hand:
  $by_hand"
}

# missing PACKAGES PROGRAMS: prints the missing packages of both lists.
missing() {
  if command -v dpkg-query >/dev/null 2>&1; then
    missing_packages $1
  fi
  missing_programs $2
}

# need PACKAGES PROGRAMS: installs the missing packages of both lists.
need() {
  install_packages $(missing "$1" "$2")
}

# configured NAME=VALUE...: succeeds if the build folder was configured with all of these.
configured() {
  [ -f "$build_dir/build.ninja" ] || return 1
  for setting in "$@"; do
    grep -q "^${setting%%=*}:[A-Z]*=${setting#*=}\$" "$build_dir/CMakeCache.txt" || return 1
  done
}

# configure NAME=VALUE...: a release build; settings of earlier calls stay as they were.
configure() {
  case "${ASPIC_PORTABLE-}" in
    "" | 0 | OFF) set -- ASPIC_PORTABLE=OFF "$@" ;;
    *) set -- ASPIC_PORTABLE=ON "$@" ;;
  esac
  case "${ASPIC_VIEWER-}" in
    0 | OFF) set -- ASPIC_VIEWER=OFF "$@" ;;
    *) set -- ASPIC_VIEWER=ON "$@" ;;
  esac
  ! configured "$@" || return 0
  for setting in "$@"; do
    set -- "$@" "-D$setting"
    shift
  done
  [ -f "$build_dir/CMakeCache.txt" ] || set -- -DASPIC_TESTS=OFF -DASPIC_BENCH=OFF -DASPIC_MESHER=OFF "$@"
  logged configure cmake -S "$root" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" ||
    die "the build could not be configured"
}

# name_of TARGETS: what a user gets from them.
name_of() {
  case $1 in
    aspic) echo "the library" ;;
    aspic-run) echo "the simulation, without viewer" ;;
    aspic_cli) echo "the program with viewer and renderer" ;;
    _aspic) echo "the Python package" ;;
    aspic_engine) echo "the program for browsers, with threads" ;;
    site) echo "the page for browsers" ;;
    bench_*) echo "the benchmark" ;;
    all) echo "everything and its tests" ;;
    *) echo "$1" ;;
  esac
}

# start_notice TEXT LOG: while this script lives, shows the text with ninja's last count in the log: on a terminal one line that
# changes, in a pipe a line every half minute; nothing in the first seconds.
start_notice() {
  pause=30 format='%s ... %s\n'
  [ ! -t 2 ] || pause=1 format='\r\033[K%s ... %s'
  (
    sleep 5 3>&- # which would keep a pipe open
    while kill -0 $$; do
      # shellcheck disable=SC2059
      printf "$format" "$1" "$(sed -n 's/^\(\[[0-9/]*\]\).*/\1/p' "$2" | tail -n 1)" >&3
      sleep $pause 3>&-
    done
  ) 3>&2 >/dev/null 2>&1 &
  notice=$!
}

end_notice() {
  kill "$notice" 2>/dev/null || true
  [ ! -t 2 ] || printf '\r\033[K' >&2
}

# build TARGETS: ninja's output goes to a log, shown when it fails.
build() {
  start_notice "Building $(name_of "$@")" "$log_dir/build.log"
  if logged build ninja -C "$build_dir" "$@"; then built=1; else built=; fi
  end_notice
  [ -n "$built" ] || die "the build failed"
}

# build_package FOLDER TARGETS...: a package that stands on the core; `build_dir` becomes its build folder.
build_package() {
  core=$build_dir
  build_dir=$root/build/$1
  package=$1
  shift
  [ -f "$build_dir/build.ninja" ] ||
    logged "configure-$package" cmake -S "$root/$package" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -Daspic_DIR="$core/package" || die "the package $package could not be configured"
  build "$@"
}

# preset NAME: the build folder of a preset, configured anew where that was with other settings.
preset() {
  build_dir=$root/build/$1
  recipe=$build_dir/preset.json
  cmp -s "$root/CMakePresets.json" "$recipe" && [ -f "$build_dir/build.ninja" ] && return
  (cd "$root" && logged "configure-$1" cmake --fresh --preset "$1") || die "the preset $1 could not be configured"
  cp "$root/CMakePresets.json" "$recipe"
}

# run_tests CTEST-ARGUMENTS...: those of the build folder, each for at most half an hour; in a pipe only the failures and the
# summary are shown.
run_tests() {
  set -- ctest --test-dir "$build_dir" --output-on-failure --no-tests=error --timeout 1800 -j "$(nproc)" "$@"
  if [ -t 1 ]; then
    "$@" --progress
    return
  fi
  mkdir -p "$log_dir"
  say "Running the tests ..."
  tests_log=$log_dir/${build_dir##*/}-tests
  { "$@" && echo 0 >"$tests_log.status" || echo $? >"$tests_log.status"; } |
    tee "$tests_log.log" | grep -v -e '^ *Start ' -e ' Passed ' || true
  return "$(cat "$tests_log.status")"
}

# The surface of the Stanford bunny: npm package `bunny` (public domain). The default scene's mesh, scenes/bunny.mesh, was made
# from it and is part of the repository.
bunny_package=bunny@1.0.1
fetch_bunny() {
  scenes=$root/scenes
  [ ! -s "$scenes/bunny.obj" ] || return 0
  need "" "nodejs:node npm"
  say "Fetching the surface of the bunny: npm package $bunny_package ..."
  folder=$(mktemp -d)
  if ! (cd "$folder" && logged npm npm pack "$bunny_package"); then
    rm -rf "$folder"
    die "the npm package $bunny_package could not be fetched (is the network away?).
Only what fills this surface with tets needs it."
  fi
  tar -xzf "$folder"/bunny-*.tgz -C "$folder"
  awk -f "$root/tools/bunny_to_obj.awk" "$folder/package/index.js" >"$folder/bunny.obj"
  mv "$folder/bunny.obj" "$scenes/bunny.obj"
  rm -rf "$folder"
}

# Programs from npm that read our results back in the tests.
tinyusdz_package=tinyusdz@0.9.0-rc10
fetch_oracles() {
  [ ! -f "$root/build/oracles/node_modules/tinyusdz/tinyusdz.wasm" ] || return 0
  say "Fetching the npm package $tinyusdz_package, which reads our USD files in the tests ..."
  logged oracles npm install --prefix "$root/build/oracles" --no-save "$tinyusdz_package" ||
    say "warning: it could not be fetched; our USD files will be read by our own parser alone"
}

# Sources that the WebAssembly build compiles: those of Debian 12, checked by their hashes.
debian_pool=http://deb.debian.org/debian/pool/main
wasm_sources="
  z/zlib/zlib_1.2.13.dfsg.orig.tar.bz2 71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1
  e/expat/expat_2.5.0.orig.tar.gz ab00ee05c7067fd10a35c5d2a4922ebba746ddd50ff83b79c828da17bbdf1757
  m/muparser/muparser_2.3.3.orig.tar.gz 91d26d8274ae9cd9c776ee58250aeddc6b574f369eafd03b25045b858a2b8177"
fetch_wasm_sources() {
  set -- $wasm_sources
  while [ $# -gt 0 ]; do
    fetch_source "$1" "$2"
    shift 2
  done
}

# fetch_source PATH HASH: unpacks a source archive of Debian into build/sources, unless it is there.
fetch_source() {
  archive=${1##*/}
  folder=$root/build/sources/${archive%%_*}
  [ ! -d "$folder" ] || return 0
  say "Fetching $archive from Debian ..."
  part=$(mktemp -d)
  if logged "source-${archive%%_*}" /usr/lib/apt/apt-helper download-file "$debian_pool/$1" "$part/$archive" "SHA256:$2" &&
    mkdir -p "$part/unpacked" "$root/build/sources" && tar -xf "$part/$archive" -C "$part/unpacked"; then
    mv "$part/unpacked" "$folder"
    rm -rf "$part"
  else
    rm -rf "$part"
    die "$debian_pool/$1 could not be fetched (is the network away?)"
  fi
}

# Prepares the build folder of a preset for WebAssembly.
wasm_preset() {
  need "$core_packages $wasm_packages" "$core_programs $viewer_programs"
  fetch_wasm_sources
  export NODE_PATH=/usr/share/nodejs # where Debian's emscripten finds its modules
  preset "$1"
}

# build_site [threads]: builds out/site/index.html; with `threads` also a file beside it with an engine for isolated pages.
build_site() {
  say "Compiling the simulation for browsers, and packing viewer, scenes and lecture with it into out/site/index.html.
This takes 5 to 25 minutes the first time; its last step, the link, takes several of them after any change."
  if [ "${1-}" = threads ]; then
    wasm_preset wasm-threads
    build aspic_engine
    threads_engine=$build_dir/bin/engine.js
  fi
  wasm_preset wasm
  build site
  [ "${1-}" != threads ] || node "$root/web/site.mjs" "$build_dir/web/page.html" "$build_dir/bin/engine.js" "$root" \
    "$root/out/site/index.html" "$threads_engine" >&2
}

# Shapes for `./run bench characters`, in build/shapes and nowhere else: the bunny, and what Debian's package libcgal-demo
# holds. What cannot be fetched is left out there.
shapes_dir=$root/build/shapes
cgal_shapes="data/meshes/armadillo.off data/meshes/elephant.off data/meshes/hand.off data/meshes/homer.off
  data/images/liver.inr.gz"
fetch_shapes() {
  mkdir -p "$shapes_dir"
  if [ ! -s "$shapes_dir/bunny.obj" ]; then
    (fetch_bunny) || say "The benchmark continues without the bunny."
    [ ! -s "$root/scenes/bunny.obj" ] || cp "$root/scenes/bunny.obj" "$shapes_dir/"
  fi
  [ -s "$shapes_dir/liver.inr.gz" ] || fetch_cgal_shapes ||
    say "warning: the package libcgal-demo could not be fetched; the benchmark runs without its shapes"
}

fetch_cgal_shapes() {
  command -v apt-get >/dev/null 2>&1 && command -v dpkg-deb >/dev/null 2>&1 || return 1
  say "Fetching shapes: Debian package libcgal-demo ..."
  folder=$(mktemp -d)
  if (cd "$folder" && logged libcgal-demo apt-get -q download libcgal-demo) &&
    dpkg-deb --extract "$folder"/libcgal-demo_*.deb "$folder" &&
    tar -xzf "$folder/usr/share/doc/libcgal-dev/data.tar.gz" -C "$folder" $cgal_shapes; then
    for shape in $cgal_shapes; do mv "$folder/$shape" "$shapes_dir/"; done
    rm -rf "$folder"
  else
    rm -rf "$folder"
    return 1
  fi
}
