// The header and the checks in C++.
#include "calls.c"
