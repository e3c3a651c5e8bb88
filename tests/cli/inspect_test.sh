#!/usr/bin/env bash
# lumel inspect: its pictures, which scene it takes, and what it refuses.
#   inspect_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

bake=(--preset preview --samples 16 --resolution 32x32 --threads 1 --sky 1,1,1)
expect 0 '' bake ok.gltf -o out "${bake[@]}" --views 2 --view-samples 1

# Without options: how texels were baked, on every page and in the views that the bake drew.
expect 0 '' inspect out
for file in inspect.json state_page0.png state_view0.png state_view1.png; do
    [ -s "out/inspect/$file" ] || complain "there is no $file: $(ls out/inspect)"
done
[ -e out/inspect/state_view2.png ] && complain 'there is a view that the bake did not draw'
grep -qx 'out/inspect/state_page0.png' out.txt || complain "what was written is not told: $(cat out.txt)"

# Every layer that the list has can be drawn; their pictures replace those of before.
expect 0 '' inspect out --layer list
names=$(awk '{ print $1 }' out.txt)
layers=$(paste -sd, <<<"$names")
for name in state coverage normal light master:sky.L4 l1:L1n.R lightmap:RGB; do
    grep -qx "$name" <<<"$names" || complain "the list has no $name: $names"
done
expect 0 '' inspect out --layer "$layers" --camera none --values
[ -e out/inspect/state_view0.png ] && complain 'pictures of an older inspection are left'
count=$(wc -l <<<"$names")
[ "$(find out/inspect -name '*_page0.png' | wc -l)" = "$count" ] || complain "not $count pictures: $(ls out/inspect)"
[ "$(find out/inspect -name '*_page0.exr' | wc -l)" = "$count" ] || complain "not $count files of numbers"
[ -s out/inspect/master_sky.L4_page0.png ] || complain 'channels of the master have no picture'
expect 0 '' compare out/inspect/light_page0.exr out/lightmap_0.exr --max-error 0
grep -q '"name": "state"' out/inspect/inspect.json || complain 'inspect.json does not name its layers'

# Views: filters, dilation, backs, cameras and threads.
view=(--layer light,state --camera '0,3,3;0,0,0;90' --resolution 64x36)
picture() { expect 0 '' inspect out -o "$1" "${view[@]}" "${@:2}"; }
differ() { cmp -s "$1" "$2" && complain "$1 is $2"; }
picture point --filter point
picture bilinear --threads 1
picture again --threads 3
picture bicubic --filter bicubic
cmp -s bilinear/light_view0.png again/light_view0.png || complain 'views depend on the number of threads'
differ point/light_view0.png bilinear/light_view0.png
differ bicubic/light_view0.png bilinear/light_view0.png
picture rings --dilation off
differ rings/state_page0.png bilinear/state_page0.png
view=(--layer state --camera '0,-3,3;0,0,0;90' --resolution 64x36)
picture magenta
picture through --backs through
differ magenta/state_view0.png through/state_view0.png
expect 0 '' inspect out -o two --camera '0,3,3;0,0,0;90' --camera 'view 1' --resolution 64x36 --page 0
[ -s two/state_view1.png ] || complain 'a second camera has no view'

# Layers of the light need no scene where there are no views; all else does, and the right one.
mkdir away
mv ok.gltf away
expect 0 '' inspect out -o dark --layer light --camera none
expect 1 'ok.gltf: the scene that was baked is not there any more' inspect out -o none
expect 1 '--scene FILE' inspect out -o none --layer light
[ -e none ] && complain 'a folder was left for nothing'
expect 0 '' inspect out -o none --scene away/ok.gltf
sed 's/"translation":\[0,2,0\]/"translation":[0,3,0]/' away/ok.gltf >lamp.gltf
expect 1 'lamp.gltf: its materials, lights or sky are not what out was baked from' inspect out --scene lamp.gltf
sed 's/"mesh":0,/"mesh":0,"scale":[2,1,1],/' away/ok.gltf >wide.gltf
expect 1 'wide.gltf: its geometry is not what out was baked from' inspect out --scene wide.gltf
mv away/ok.gltf .
sed -i 's/"source_path"/"was_once"/' out/manifest.json
expect 1 'does not say where the scene is' inspect out
expect 0 '' inspect out --scene ok.gltf

# The layout may be one that was kept, packed anew, or the file's own.
expect 0 '' bake ok.gltf -o kept "${quick[@]}" --sky 1,1,1
expect 0 '' bake ok.gltf -o again_kept --preset preview --samples 1 --views 0 --sky 1,1,1 --atlas kept/manifest.json
expect 0 '' inspect again_kept --camera none
expect 0 '' bake ok.gltf -o collapsed --preset preview --samples 4 --views 0 --sky 1,1,1 --collapse 0.9 --texels-per-metre 16
expect 0 '' inspect collapsed --camera none

# What there is not.
expect 2 "there is no layer 'glow'" inspect out --scene ok.gltf --layer glow
expect 2 'has no channels' inspect out --scene ok.gltf --layer master:glow
expect 2 'is of a file that is not there' inspect out --scene ok.gltf --layer nothing:R
expect 2 'names no file of the folder' inspect out --scene ok.gltf --layer ../out/master:count
expect 2 'there is no page 7' inspect out --scene ok.gltf --page 7
expect 2 '' inspect out --filter nearest
expect 2 "there is no camera 'mine'" inspect out --scene ok.gltf --camera mine
expect 1 'empty: there is no such folder' inspect empty
mkdir empty
expect 1 'empty: is no bake of lumel' inspect empty --layer list
mkdir theirs
echo mine >theirs/state_page0.png
expect 1 'state_page0.png' inspect out --scene ok.gltf -o theirs
[ "$(cat theirs/state_page0.png)" = mine ] || complain 'a file of somebody was replaced'

finish
