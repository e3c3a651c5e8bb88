#!/usr/bin/env bash
# What `lumel encode` writes as textures, read by parsers and decoders of others (scripts/oracle/texture_files.py).
#   texture_oracle_test.sh LUMEL SAMPLES PYTHON SCRIPT
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

check() {
    "$3" "$4" check "$lumel" "$5"
    local code=$?
    [ $code = 77 ] && exit 77
    [ $code = 0 ] || complain "texture_files.py of $5: exit code $code"
}

"$2" . gallery >/dev/null || complain 'no sample scene'
# Pages of several sizes: files of their own.
expect 0 '' bake gallery.glb -o apart --preset preview --samples 16 --views 0 --max-page 96 --texels-per-metre 6
check "$@" apart
# Three of one size: layers, with three levels each.
expect 0 '' bake ok.gltf -o layers "${quick[@]}" --mips 2
"$3" - <<'EOF'
import json
with open("layers/manifest.json") as text:
    manifest = json.load(text)
manifest["pages"] = 3 * manifest["pages"]
with open("layers/manifest.json", "w") as text:
    json.dump(manifest, text)
EOF
check "$@" layers
grep -q '"layer": 2' layers/*/encoded_l1-hhd.json || complain 'no layers'
grep -q '"level": 2' layers/*/encoded_l1-hhd.json || complain 'no levels'
finish
