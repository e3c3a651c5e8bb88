#!/usr/bin/env bash
# `lumel render --baked` without options of light shows the light that the bake recorded.
#   light_of_bake_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

view=(--samples 4 --resolution 32x16)
same() { cmp -s "$1" "$2" || complain "$1 differs from $2"; }
differ() { cmp -s "$1" "$2" && complain "$1 is $2"; }
# silent TEXT: standard error of the command before does not have it.
silent() { ! grep -qF -- "$1" err.txt || complain "says $1: $(cat err.txt)"; }

# Without options there is nothing to take.
expect 0 '' bake ok.gltf -o plain "${quick[@]}" --progress none
expect 0 '' render ok.gltf -o plain.pfm --baked plain "${view[@]}"
silent 'lit as'
silent other-light

# Constant sky, sun, layers and scales.
light=(--sky 0.25,0.5,1 --sky-intensity 2 --sun-direction 1,-2,0 --sun-illuminance 0.5 --sun-angle 3)
expect 0 '' bake ok.gltf -o lit "${quick[@]}" "${light[@]}" --include direct,sky --direct-scale 3
expect 0 "lit as the bake was: --sky 0.25,0.5,1 --sky-intensity 2 --sun-direction" render ok.gltf -o taken.pfm --baked lit "${view[@]}"
for part in '--sun-illuminance 0.5 --sun-angle 3 --include direct,sky --direct-scale 3'; do
    grep -qF -- "$part" err.txt || complain "no $part in $(cat err.txt)"
done
silent other-light
expect 0 'lit as the bake was: --include direct,sky --direct-scale 3' render ok.gltf -o given.pfm --baked lit "${view[@]}" "${light[@]}"
silent other-light
same taken.pfm given.pfm
expect 0 '[other-light, 1]' render ok.gltf -o other.pfm --baked lit "${view[@]}" --sky 0,1,0
silent --sun-direction
differ other.pfm taken.pfm

# Of the light of another scene nothing is said.
sed 's/"translation":\[0,2,0\]/"translation":[0,3,0]/; s/"mesh":0,/"mesh":0,"scale":[2,1,1],/' ok.gltf >wide.gltf
expect 1 'was baked from another scene than wide.gltf' render wide.gltf -o wide.pfm --baked lit "${view[@]}"
silent other-light
silent 'lit as'
mkdir notes
expect 1 'notes: is no bake of lumel' render ok.gltf -o notes.pfm --baked notes "${view[@]}"
expect 1 'lit/lightmap_0.exr' compare lit lit

# A sky map, from its folder, from another, after both were moved, changed, gone.
mkdir maps
expect 0 '' render ok.gltf -o maps/sky.hdr --samples 16 --resolution 32x16 --sky 1,1,1 --camera '0,3,3;0,0,0;90'
map=(--sky maps/sky.hdr --sky-rotation 90 --sky-blur 5)
expect 0 '' bake ok.gltf -o mapped "${quick[@]}" "${map[@]}"
expect 0 '' render ok.gltf -o given.pfm --baked mapped "${view[@]}" "${map[@]}"
silent 'lit as'
expect 0 '--sky maps/sky.hdr --sky-rotation 90 --sky-blur 5' render ok.gltf -o taken.pfm --baked mapped "${view[@]}"
silent other-light
same taken.pfm given.pfm
differ taken.pfm plain.pfm
mkdir elsewhere
mv maps mapped ok.gltf elsewhere
cd elsewhere/maps || exit 1
expect 0 '--sky sky.hdr' render ../ok.gltf -o ../../moved.pfm --baked ../mapped "${view[@]}"
cd ../.. || exit 1
same moved.pfm given.pfm
mv elsewhere/* .
expect 0 '' render ok.gltf -o maps/sky.hdr --samples 16 --resolution 32x16 --sky 2,1,1 --camera '0,3,3;0,0,0;90'
expect 0 '[other-light, 1]: sky map maps/sky.hdr' render ok.gltf -o changed.pfm --baked mapped "${view[@]}"
rm maps/sky.hdr
expect 1 'maps/sky.hdr: the sky map that lit the bake is not there' render ok.gltf -o gone.pfm --baked mapped "${view[@]}"
[ -e gone.pfm ] && complain 'a picture without its sky was written'
expect 0 '' render ok.gltf -o gone.pfm --baked mapped "${view[@]}" --sky 0,0,0

# What acts on the sidecar's sky is taken, too; a sidecar that changed is noticed.
cp ok.gltf side.gltf
echo '{ "version": 1, "sky": { "color": [1, 1, 1] } }' >side.lumel.json
expect 0 '' bake side.gltf -o sided "${quick[@]}" --sky-intensity 3
expect 0 'lit as the bake was: --sky-intensity 3' render side.gltf -o side.pfm --baked sided "${view[@]}"
silent other-light
echo '{ "version": 1, "sky": { "color": [1, 2, 1] } }' >side.lumel.json
expect 0 '[other-light, 1]' render side.gltf -o side.pfm --baked sided "${view[@]}"

finish
