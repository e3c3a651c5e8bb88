#!/usr/bin/env bash
# What --help says: defaults, formats, and which of two options is needed. One line per promise.
#   help_test.sh LUMEL
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"

# says COMMAND TEXT: its help, on however many lines.
says() {
    expect 0 '' "$1" --help
    # CLI11 writes a default as =x, later as [x] behind what else is in brackets.
    sed -E 's/ \[([^]]*)\]( *$|  )/=\1\2/' out.txt | tr -s ' \n' ' ' | grep -qF -- "$2" || complain "lumel $1 --help: no '$2'"
}
says encode 'hdr}=exr; with auto, exr or ktx2'
says encode '=bc7; with auto, the best'
says encode '{fast,medium,best}=medium'
says encode '10000000]=4000'
says encode '=DIR Folder to write to'
says encode 'needed, or --table'
says encode '1000]=any'
says compare 'PFM, PNG, JPEG or PGM'
says compare 'white: PGM, PNG'
says compare '=none Exit with 1'
says bake '=off Relative error'
says bake '=off Seconds of tracing'
says bake '=0.95 Confidence'
says bake '=fixed; error with --error'
says bake '=none Ceiling'
says bake "=the sidecar's, or none Sky"
says bake '=no sun X,Y,Z'
says atlas '=a new layout'
says render "default: view 0, the scene's first camera where it has one"
says inspect '=the views that the bake drew'
says inspect '{point,bilinear,bicubic}=bilinear'
for command in bake atlas render pack encode check inspect; do says $command 'auto: a bar on a terminal, else plain'; done

finish
