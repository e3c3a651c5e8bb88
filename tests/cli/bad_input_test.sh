#!/usr/bin/env bash
# Bad options, bad files and interruption: exit code, message, nothing left behind. One line per case.
#   bad_input_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

nan=7fc00000 beyond='\x00\x00\x02\x00\x01\x00\x00\x00\x03\x00\x09\x00'
floor "$(buffer "$beyond" "${square[@]}")" >index.gltf
floor "$(buffer "$good" $nan "${square[@]:1}")" >nan.gltf
sed 's/"mesh":0/"mesh":7/' ok.gltf >mesh.gltf
sed 's/"POSITION":0/"POSITION":9/' ok.gltf >accessor.gltf
sed 's/"extensionsUsed"/"extensionsRequired":["ACME_x"],"extensionsUsed"/' ok.gltf >required.gltf
sed 's/,{"translation.*}}}\]/]/; s/\[0,1\]/[0]/' ok.gltf >dark.gltf
sed 's/"intensity":100/"intensity":3e38/' ok.gltf >bright.gltf
cp ok.gltf side.gltf
echo '{ "sky": ' >side.lumel.json
echo hello >text.glb
printf '#?RADIANCE\n' >sky.hdr
echo '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"nothing"}]}' >empty.gltf
sed 's/"name":"floor"},/"name":"floor","extras":{"lightmap":false}},/' ok.gltf >probe.gltf
# textured FILE: the floor with this file as its texture
textured() {
    local material='{"name":"paint","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}'
    local texture="\"textures\":[{\"source\":0}],\"images\":[{\"name\":\"wood\",\"uri\":\"$1\"}]"
    sed "s/\"indices\":1}/\"indices\":1,\"material\":0}/; s/^\"accessors\"/\"materials\":[$material],$texture,&/" ok.gltf
}
textured gone.png >missing.gltf
textured huge.png >huge.gltf
# No more than a header that says 16384 x 16384.
printf '\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\x06\0\0\0' >huge.png

expect 0 '' bake ok.gltf -o out "${quick[@]}"
expect 0 '' bake ok.gltf -o out/ "${quick[@]}" --sky 1,1,1
before=$(cat out/* | cksum)

expect 0 '[already-baked, 1]: out/scene.glb' bake out/scene.glb -o twice "${quick[@]}"
grep -q already-baked twice/report.json || complain 'the report does not say that lit output was baked again'

# What a bake says at its end: where to look, and that nothing is to be seen.
expect 0 '' bake ok.gltf -o lit/ "${quick[@]}" --sky 1,1,1
grep -qx 'lit scene: lit/scene.glb' out.txt || complain "the summary does not name the scene: $(cat out.txt)"
grep -q '^pictures: lit/preview_atlas_' out.txt || complain "the summary does not name the pictures: $(cat out.txt)"
grep -q no-light lit/report.json && complain 'a lit bake is said to be black'
sed 's/"translation":\[0,2,0\]/"translation":[0,-2,0]/' ok.gltf >below.gltf
expect 0 '[no-light, 1]: below.gltf' bake below.gltf -o below "${quick[@]}"
"$lumel" info dark.gltf | grep -q 'light *none' || complain 'info does not say that there is no light'

# Radiance and a tone-mapped picture of it.
for kind in png exr pfm; do
    expect 0 '' render ok.gltf -o view.$kind --samples 1 --resolution 16x16
done
for pair in 'view.exr view.png' 'view.png view.pfm'; do
    # shellcheck disable=SC2086
    expect 0 mixed-kinds compare $pair --json
    for figure in nrmse relmse_without_worst; do
        grep -q "\"$figure\"" out.txt || complain "compare $pair: no $figure in $(cat out.txt)"
    done
done
expect 0 '[codes]' compare view.png view.png
{ printf 'PF\n16 16\n-1.0\n' && head -c 3072 /dev/zero; } >black.pfm
expect 0 '[black-reference]' compare view.exr black.pfm
"$lumel" compare view.exr view.pfm >out.txt 2>err.txt || complain "compare view.exr view.pfm: exit code $?"
[ -s err.txt ] && complain "compare view.exr view.pfm: says $(cat err.txt)"

# A disk without room for what is printed.
if [ -w /dev/full ]; then
    "$lumel" info ok.gltf >/dev/full 2>err.txt && complain 'info is content with a full disk'
    grep -q 'standard output: cannot be written' err.txt || complain "info does not say that its output is lost: $(cat err.txt)"
fi

# A sky in units of its own beside a sun in lux.
sun=(--sun-direction 0,-1,0 --sun-illuminance 100000)
expect 0 '[dark-sky, 1]: the sky lights a plane with 3.14 lux' bake ok.gltf -o lit/ "${quick[@]}" --sky 1,1,1 "${sun[@]}"
expect 0 '' bake ok.gltf -o lit/ "${quick[@]}" --sky 3000,3000,3000 "${sun[@]}"
grep -q dark-sky lit/report.json && complain 'a bright sky is said to be black'

# The pictures of a bake are one stage, whose progress never falls.
expect 0 '"stage":"views","fraction":1.0000' bake ok.gltf -o views --preset preview --samples 1 \
    --resolution 32x32 --views 2 --view-samples 64 --progress json
grep -F '"stage":"views"' err.txt | sed 's/.*"fraction":\([0-9.]*\).*"rays":\([0-9]*\).*/\1 \2/' >views.txt
[ "$(wc -l <views.txt)" -gt 2 ] || complain "progress of views is: $(cat views.txt)"
awk '$1 < fraction || $2 < rays { exit 1 } { fraction = $1; rays = $2 }' views.txt ||
    complain "progress of views falls: $(cat views.txt)"
grep -q '"stage":"render"' err.txt && complain 'pictures of a bake report for themselves'

# Every error is one line that begins the same.
usage() {
    expect 2 "$@"
    [ "$(wc -l <err.txt)" = 1 ] && grep -q '^lumel: error: ' err.txt || complain "lumel ${*:2}: says $(cat err.txt)"
    [ -s out.txt ] && complain "lumel ${*:2}: standard output has $(cat out.txt)"
    grep -q -- '--help' err.txt || complain "lumel ${*:2}: does not point to --help: $(cat err.txt)"
}
usage 'a command is missing'
usage "'foo'" foo
usage "'foo'" foo --json
usage "'--frobnicate'" --frobnicate
usage --frobnicate bake ok.gltf -o x --frobnicate
usage 'lumel bake --help' bake ok.gltf -o x --frobnicate
usage 'did you mean --samples?' bake ok.gltf -o x --sample 5
usage 'did you mean --sky?' render ok.gltf -o x.png --skye=1,1,1
usage 'did you mean bake?' bak ok.gltf
usage SCENE bake
usage --output bake ok.gltf
usage ultra bake ok.gltf -o x --preset ultra
usage --resolution bake ok.gltf -o x --resolution 3
usage --sun-direction bake ok.gltf -o x --sun-angle 1
usage "--sky: 'blue'" bake ok.gltf -o x --sky blue
usage "--sky: '1,1'" render ok.gltf -o v.png --sky 1,1
expect 1 'gone.hdr: --sky:' bake ok.gltf -o x --sky gone.hdr
expect 2 "ok.gltf: node 'floor'" bake ok.gltf -o x "${quick[@]}" --uv1 scene
expect 2 '--uv1 scene' bake ok.gltf -o x "${quick[@]}" --uv1 scene
for arguments in --help --version 'bake --help'; do
    # shellcheck disable=SC2086
    "$lumel" $arguments >out.txt 2>err.txt || complain "lumel $arguments: exit code $?"
    [ -s out.txt ] && [ ! -s err.txt ] || complain "lumel $arguments: says $(cat out.txt err.txt)"
done
for pair in --preset=ultra --samples=many --samples=-4 --sun-direction=1,2 --sun-direction=0,0,0 --include=light --include= \
    --sky=1,1 --sky=nan,1,1 --sky-intensity=nan --sky-intensity=inf --ao-distance=nan --ao-distance=inf --sun-direction=inf,0,0 \
    --texels-per-metre=inf --direct-scale=nan --indirect-scale=inf --texels-per-metre=nan --sky-rotation=nan --direct-scale=-1 \
    --max-memory=abc --max-memory=5 --samples=0 --resolution=0x5 --resolution=99999x99999 --threads=5000; do
    expect 2 "${pair%%=*}" bake ok.gltf -o x --resolution 32x32 "$pair"
done
# Nothing is no value: not "as if it were not given".
for option in --sky --sun-direction; do
    expect 2 "$option" bake ok.gltf -o x "${quick[@]}" $option ''
    expect 2 "$option" render ok.gltf -o v.png $option ''
done
for option in --resolution --max-memory; do
    expect 2 "$option" bake ok.gltf -o x --preset preview $option ''
done
for option in --camera --baked --resolution; do
    expect 2 "$option" render ok.gltf -o v.png $option ''
done
[ -e x ] && complain 'an option without a value was baked'
for pair in --sun-angle=1 --sun-color=1,1,1 --sun-illuminance=5; do
    expect 2 --sun-direction bake ok.gltf -o x "${quick[@]}" "$pair"
    expect 2 --sun-direction render ok.gltf -o v.png "$pair"
done
for pair in --sky-rotation=90 --sky-blur=5 --sky-intensity=2; do
    expect 2 "${pair%%=*} needs a sky" bake ok.gltf -o x "${quick[@]}" "$pair"
    expect 2 "${pair%%=*} needs a sky" render ok.gltf -o v.png "$pair"
done
expect 2 '--sky-blur needs a sky map' bake ok.gltf -o x "${quick[@]}" --sky 1,1,1 --sky-blur 5
expect 0 '' bake ok.gltf -o x "${quick[@]}" --sky 1,1,1 --sky-intensity 2
for pair in --error=0.1 --confidence=0.9; do
    expect 0 '' bake ok.gltf -o x "${quick[@]}" --stop flux "$pair"
done
expect 2 '--confidence needs --error' bake ok.gltf -o x "${quick[@]}" --confidence 0.9
expect 2 --error bake ok.gltf -o x "${quick[@]}" --error 5
expect 2 '--stop fixed' bake ok.gltf -o x "${quick[@]}" --stop fixed --error 0.1
expect 2 '--time does not go with --error' bake ok.gltf -o x "${quick[@]}" --time 5 --error 0.1
for value in 0 nan -1; do expect 2 --time bake ok.gltf -o x "${quick[@]}" --time "$value"; done
expect 0 '' bake ok.gltf -o x "${quick[@]}" --error 0.1
expect 0 '' bake ok.gltf -o x "${quick[@]}" --time 1
for pair in --error=nan --confidence=nan; do
    expect 2 "${pair%%=*}" bake ok.gltf -o x "${quick[@]}" --stop flux "$pair"
done
expect 0 '' bake ok.gltf -o x "${quick[@]}" --sun-direction 1e30,-1e30,0
expect 2 --two-sided render ok.gltf -o v.png --two-sided
expect 2 -o bake ok.gltf -o '' "${quick[@]}"
expect 2 "camera 'nowhere'" render ok.gltf -o v.png --camera nowhere
expect 2 'same point' render ok.gltf -o v.png --camera '0,0,0;0,0,0;60'
expect 2 .bmp render ok.gltf -o v.bmp
expect 1 'its folder does not exist' render ok.gltf -o gone/v.png
expect 1 'gone: there is no such folder' render ok.gltf -o v.png --baked gone

expect 1 'no such file' bake gone.glb -o out "${quick[@]}"
expect 1 'is a folder' bake . -o out "${quick[@]}"
expect 1 'neither a .glb nor a .gltf' bake text.glb -o out "${quick[@]}"
expect 1 'sky.hdr: is a picture, not a scene (a sky map is given with --sky' bake sky.hdr -o out "${quick[@]}"
expect 1 "mesh 0 'floor', primitive 0, vertex 0" bake nan.gltf -o out "${quick[@]}"
expect 1 'index 5 is 9' bake index.gltf -o out "${quick[@]}"
expect 1 'node 0' bake mesh.gltf -o out "${quick[@]}"
expect 1 "mesh 0 'floor', primitive 0" bake accessor.gltf -o out "${quick[@]}"
expect 1 ACME_x bake required.gltf -o out "${quick[@]}"
expect 1 'intensity is 3e+38' bake bright.gltf -o out "${quick[@]}"
expect 1 --sky-intensity bake ok.gltf -o out "${quick[@]}" --sky 1,1,1 --sky-intensity 3e38
expect 1 --sky-intensity render ok.gltf -o v.png --sky 1,1,1 --sky-intensity 3e38
expect 1 side.lumel.json bake side.gltf -o out "${quick[@]}"
expect 1 --sky bake dark.gltf -o out "${quick[@]}"
expect 1 --sky bake dark.gltf -o out "${quick[@]}" --sun-direction 0,-1,0 --sun-illuminance 0
expect 1 text.glb bake ok.gltf -o out "${quick[@]}" --sky text.glb
expect 1 'empty.gltf: the scene has no triangles (give a scene with at least one mesh of triangles in its default scene)' \
    bake empty.gltf -o out "${quick[@]}"
expect 1 'probe.gltf: no surface of the scene gets lightmap texels (every node is of another class than lightmap' \
    bake probe.gltf -o out "${quick[@]}"
wood="image 0 'wood', used as baseColorTexture of material 0 'paint'"
expect 1 "missing.gltf: $wood: its file 'gone.png' cannot be read: there is no such file (put the file beside the scene)" \
    bake missing.gltf -o out "${quick[@]}"
expect 1 "huge.gltf: $wood: has 16384 x 16384 pixels; at most 8192 x 8192 are read (make it smaller)" \
    bake huge.gltf -o out "${quick[@]}"
expect 1 --max-memory bake ok.gltf -o out "${quick[@]}" --max-memory 1K
# What it says it needs is enough, and is not exceeded.
need=$(sed -n 's/.*this bake is predicted to need about \([0-9]*\) MB.*/\1/p' err.txt)
expect 1 "need about $need MB" bake ok.gltf -o need --preset preview --samples 1 --threads 1 --resolution 32x32 --max-memory $((need - 1))M
expect 0 '' bake ok.gltf -o need --preset preview --samples 1 --threads 1 --resolution 32x32 --views 1 --max-memory "${need}M"
peak=$(sed -n 's/.*"peak_memory_bytes": \([0-9]*\).*/\1/p' need/report.json)
[ "$peak" -le $((need << 20)) ] || complain "a bake that needs $need MB took $peak bytes"
expect 1 'is not a folder' bake ok.gltf -o text.glb "${quick[@]}"
expect 1 'would be replaced' bake out/scene.glb -o out "${quick[@]}"
# Folders that may not be written to. Root may write to all: then as nobody, where that one can run the command.
mkdir -m 555 locked
drop=
if [ -w locked ]; then
    chmod 755 .
    drop='setpriv --reuid=65534 --regid=65534 --clear-groups'
fi
printf '#!/bin/sh\nexec %s "%s" "$@"\n' "$drop" "$lumel" >unprivileged
chmod +x unprivileged
if ./unprivileged info ok.gltf >/dev/null 2>&1; then
    remedy='(check the permissions of the folder, or choose another with -o)'
    lumel=./unprivileged expect 1 "locked: writing to the folder failed: Permission denied $remedy" \
        bake ok.gltf -o locked "${quick[@]}"
    lumel=./unprivileged expect 1 "locked/new: creating the folder failed: Permission denied $remedy" \
        bake ok.gltf -o locked/new "${quick[@]}"
    lumel=./unprivileged expect 1 "locked/v.png" render ok.gltf -o locked/v.png --samples 1 --resolution 16x16
    [ -z "$(ls -A locked)" ] || complain "locked/ holds $(ls -A locked)"
else
    echo 'skipped: nobody here lacks the permission to write'
fi
mkdir web
echo '{"name": "a page"}' >web/manifest.json
expect 1 web/manifest.json bake ok.gltf -o web "${quick[@]}"
[ "$(ls web)" = manifest.json ] || complain "web/ holds $(ls web)"
[ "$(cat out/* | cksum)" = "$before" ] || complain 'a failed bake changed the older output'

# What was questionable in a scene may be why a run failed: warnings come before the error, too.
sed 's/"meshes":/"materials":[{"extensions":{"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":1}}}],&/
    s/"indices":1}/"indices":1,"material":0}/' ok.gltf >warned.gltf
sed 's/"mesh":0/"mesh":0,"extras":{"lightmap":false}/' warned.gltf >untextured.gltf
expect 1 'warning: ' atlas untextured.gltf -o warned --preset preview
expect 1 'warning: ' bake untextured.gltf -o warned "${quick[@]}"
expect 2 'warning: ' render warned.gltf -o warned.png --camera nowhere

# Pictures show the layers that the bake sums. Here all light is direct.
for include in direct sky indirect; do
    expect 0 '' render ok.gltf -o $include.pfm --include $include --samples 4 --resolution 32x32
done
expect 0 '' render ok.gltf -o dark.pfm --direct-scale 0 --samples 4 --resolution 32x32
cmp -s direct.pfm dark.pfm && complain 'render ignores --direct-scale, or shows no light at all'
cmp -s sky.pfm dark.pfm || complain 'render ignores --include sky'
cmp -s indirect.pfm dark.pfm || complain 'render ignores --include indirect'
# Without light the truth in the views has no noise that could depend on the seed; with light, its edges have.
for seed in 1 2; do
    for include in direct sky; do
        expect 0 '' bake ok.gltf -o $include$seed --preset preview --resolution 32x32 --samples 1 --views 1 \
            --view-samples 1 --seed $seed --include $include
    done
done
cmp -s direct1/preview_view_0.png direct2/preview_view_0.png && complain 'views without noise'
cmp -s sky1/preview_view_0.png sky2/preview_view_0.png || complain 'views ignore --include'

# milliseconds SIGNAL STAGE COMMAND...: stops it as soon as it reports this stage; sets `code`, its exit code, and `took`.
milliseconds() {
    local signal=$1 stage=$2 process begin
    shift 2
    : >err.txt
    "$lumel" "$@" --progress json >out.txt 2>err.txt &
    process=$!
    until grep -qF "\"stage\":\"$stage\"" err.txt; do
        kill -0 $process 2>/dev/null || break
        sleep 0.02
    done
    begin=$(date +%s%N)
    kill -s "$signal" $process
    wait $process
    code=$?
    took=$((($(date +%s%N) - begin) / 1000000))
}
# stop SIGNAL STAGE COMMAND...: within the promised second; once more where the machine may have had other things to do.
stop() {
    local signal=$1 stage=$2 code took
    milliseconds "$@"
    [ $took -lt 1000 ] || milliseconds "$@"
    [ $took -lt 1000 ] || complain "$signal in $stage: took $took ms"
    [ $code = 1 ] || complain "$signal in $stage: exit code $code"
    grep -qF cancelled err.txt || complain "$signal in $stage: says $(cat err.txt)"
    compgen -G '*.partial-*' >/dev/null && complain "$signal in $stage: left $(echo ./*.partial-*)"
    [ "$(cat out/* | cksum)" = "$before" ] || complain "$signal in $stage: the older output changed"
}
# Many texels of few samples: the stage reports when the first of them are done.
stop TERM trace bake ok.gltf -o out --resolution 1024x1024 --texels-per-metre 10 --samples 1000
# A large page takes seconds to write.
stop INT write bake ok.gltf -o out --resolution 8192x8192 --texels-per-metre 10 --samples 1
stop INT render render ok.gltf -o picture.exr --resolution 512x512 --samples 100000
[ -e picture.exr ] && complain 'a stopped render left a picture'
# The pictures of a large page take seconds, too.
stop INT unwrap atlas ok.gltf -o layout --resolution 4096x4096
[ -e layout ] && complain 'a stopped atlas left its folder'

# A disk that is full, wherever in the output that is: files may grow to so many blocks of 1024 bytes, and what a bake
# writes is larger.
for blocks in 1 20; do
    (
        trap '' XFSZ
        ulimit -f $blocks
        "$lumel" bake ok.gltf -o full --resolution 128x128 --samples 4 --views 0 --sky 1,1,1 >out.txt 2>err.txt
    )
    code=$?
    [ $code = 1 ] || complain "full disk at $blocks kB: exit code $code"
    grep -qF 'full/' err.txt || complain "full disk at $blocks kB: names no file: $(cat err.txt)"
    compgen -G 'full*' >/dev/null && complain "full disk at $blocks kB: left $(echo full*)"
done

finish
