# Sourced, from the root of the checkout, by the scripts that bake real scenes: finds `data`, the folder of the scenes, where
# there is none of which the script ends well, and `lumel`, the program, which it builds first unless LUMEL_BUILD names another build folder; sets `daylight`.
# shellcheck shell=bash disable=SC2034
data=$(realpath -m "${LUMEL_DATA:-../shared/data}/scenes")
if [ ! -d "$data" ]; then
    echo "$0: there is no $data: nothing is measured (set LUMEL_DATA)" >&2
    exit 0
fi
build=${LUMEL_BUILD:-build/release}
if [ "$build" = build/release ]; then
    scripts/bootstrap
    scripts/build release -- lumel
fi
lumel=$(realpath "$build/lumel")

# Scenes without lights of their own get this sky and sun.
daylight=(--sky "0.7,0.9,1.3" --sun-direction "0.4188,-0.7614,-0.4949" --sun-illuminance 14 --sun-color "1,0.893,0.714")
