// The driver includes this file and uses nothing of it.
#pragma once
#include <cstdarg>
