// Everything a user of the library includes.
#pragma once

#include "lumel/bake.h"
#include "lumel/bake_folder.h"
#include "lumel/context.h"
#include "lumel/load.h"
#include "lumel/options.h"
#include "lumel/page.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "lumel/vec.h"
