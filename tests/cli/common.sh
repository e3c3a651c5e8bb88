# shellcheck shell=bash
# What the tests of the command share; source it with the command as first argument. They run in a folder of their own,
# which has ok.gltf: a floor of two triangles under a point light.
set -uo pipefail
lumel=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

complain() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# expect CODE TEXT ARGUMENTS...: exit code, and TEXT in what standard error says.
expect() {
    local code=$1 text=$2 got
    shift 2
    timeout 60 "$lumel" "$@" >out.txt 2>err.txt
    got=$?
    [ $got = "$code" ] || complain "lumel $*: exit code $got, not $code"
    [ -z "$text" ] || grep -qF -- "$text" err.txt || complain "lumel $*: no '$text' in: $(cat err.txt)"
    compgen -G '*.partial-*' >/dev/null && complain "lumel $*: left $(echo ./*.partial-*)"
    return 0
}

# A floor of two triangles under a point light. scene NAME POSITIONS-COUNT INDICES-BASE64
floor() {
    cat <<EOF
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"name":"floor"},{"translation":[0,2,0],"extensions":{"KHR_lights_punctual":{"light":0}}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":100}]}},
"meshes":[{"name":"floor","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"buffers":[{"byteLength":60,"uri":"data:;base64,$1"}]}
EOF
}
one=3f800000 minus=bf800000 zero=00000000
# words as hexadecimal big-endian floats, then the indices as bytes; glTF is little-endian
buffer() {
    local word
    {
        for word in "${@:2}"; do printf '%b' "\x${word:6:2}\x${word:4:2}\x${word:2:2}\x${word:0:2}"; done
        printf '%b' "$1"
    } | base64 -w0
}
good='\x00\x00\x02\x00\x01\x00\x00\x00\x03\x00\x02\x00'
square=("$minus" $zero "$minus" $one $zero "$minus" $one $zero $one "$minus" $zero $one)
floor "$(buffer "$good" "${square[@]}")" >ok.gltf
# The fastest bake.
quick=(--preset preview --samples 1 --views 0 --resolution 32x32 --threads 1)

finish() {
    [ $failures = 0 ] && echo 'all cases as expected'
    exit $((failures > 0))
}
