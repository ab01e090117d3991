#pragma once

#include <catch2/catch.hpp>

#include "core/standard_library.hpp"
