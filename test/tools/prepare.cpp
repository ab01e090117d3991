#include "prepare.hpp"

[[gnu::weak]] int skein::test::prepare() { return 0; }
