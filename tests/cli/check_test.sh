#!/usr/bin/env bash
# lumel check: exit codes, JSON, the page, and folders that are no bakes.
#   check_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

expect 0 '' bake ok.gltf -o out --texels-per-metre 16 --samples 64 --views 0 --sky 1,1,1 --preset preview
expect 0 '' check out
grep -q '^seams: no seams to measure$' out.txt || complain "a floor of one piece has seams: $(cat out.txt)"
grep -q 'seam_p99' out.txt && complain "there is a figure of seams that are none: $(cat out.txt)"
grep -q '^ok .*not_finite .*(at most 0)' out.txt || complain "a limit that is kept is not ok: $(cat out.txt)"
grep -q '^  *unconverged .*--noisy' out.txt || complain "a figure without a limit has a verdict: $(cat out.txt)"
grep -q 'not_finite\|hold no number' out.txt || complain "check says nothing of what it looked at: $(cat out.txt)"
[ "$(tail -n 1 out.txt)" = 'passed: all 5 limits are kept' ] || complain "there is no verdict: $(cat out.txt)"
expect 0 '' check out --json --html page.html
grep -q '"passed": *true' out.txt || complain "the JSON does not say that all is well: $(cat out.txt)"
grep -qi '<html' page.html || complain 'there is no page'
# No bake is without any noise.
expect 1 '' check out --max-unconverged 0 --noisy 0.000001 --html noisy.html
grep -q '^FAILED unconverged .*by --max-unconverged 0)' out.txt || complain "what failed names no option: $(cat out.txt)"
grep -q 'class=bad>failed: --max-unconverged' noisy.html || complain 'the page names no option'
[ "$(tail -n 1 out.txt)" = 'FAILED: of 6 limits these are not kept: unconverged' ] || complain "there is no verdict: $(cat out.txt)"
# What the bake warned of is said again; not everybody ships its report.
grep -q '^the bake warned of \[missing-normals\], 1 times: ' out.txt || complain "check hides a warning: $(cat out.txt)"
cp -r out told
rm told/report.json
expect 0 '' check told
echo '{"warnings": 3}' >told/report.json
expect 1 'told/report.json' check told
expect 1 'empty: there is no such folder' check empty
mkdir empty
expect 1 'empty: is no bake of lumel' check empty
expect 1 'ok.gltf: is a file, not the folder of a bake' check ok.gltf
cp -r out cut
head -c 300 out/lightmap_0.exr >cut/lightmap_0.exr
expect 1 'cut/' check cut
cp -r out other
expect 0 '' bake ok.gltf -o smaller --resolution 32x32 --samples 1 --views 0 --sky 1,1,1
cp smaller/lightmap_0.exr other/
expect 1 'other/' check other
expect 2 '' check out --max-overlaps many

finish
