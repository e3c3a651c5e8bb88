// Everything a user of the library includes.
#pragma once

#include "lumel/bake.h"
#include "lumel/context.h"
#include "lumel/options.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "lumel/vec.h"
