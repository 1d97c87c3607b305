#!/bin/sh
# Installs the test: builds the sources that WAVECREST_SOURCE names, and leaves a launcher under the test's name.
set -e
trap 'echo $? > ~/install-exit-status' EXIT
if [ -z "$WAVECREST_SOURCE" ]; then
  echo "WAVECREST_SOURCE is not set; expected the folder of wavecrest's sources" >&2
  exit 2
fi
cmake -S "$WAVECREST_SOURCE" -B build -DCMAKE_BUILD_TYPE=Release -DWAVECREST_TESTS=OFF -DWAVECREST_BENCH=OFF
cmake --build build --target wavecrest wavecrest_scene_assets --parallel "$NUM_CPU_CORES"

cat > wavecrest <<LAUNCHER
#!/bin/sh
"$PWD/build/wavecrest" bench "\$@" --json result.json > "\$LOG_FILE" 2>&1
status=\$?
python3 -c 'import json
rate = json.load(open("result.json"))["scenes"][0]["methods"][0]["paths_per_second"]
print(f"Result: {rate / 1e6:.4f}")' >> "\$LOG_FILE"
echo \$status > ~/test-exit-status
LAUNCHER
chmod +x wavecrest
