/// \file
/// All of carom's public API.
#pragma once

#include <carom/base.hpp>
#include <carom/body.hpp>
#include <carom/collision.hpp>
#include <carom/events.hpp>
#include <carom/observers.hpp>
#include <carom/region.hpp>
#include <carom/time_of_impact.hpp>
#include <carom/world.hpp>
