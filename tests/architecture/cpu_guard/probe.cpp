// A program with the guard and an initialiser of its own: prints what it got to.

#include <cstdio>

namespace {

const int kInitialised = std::puts("initialised");

}  // namespace

int main() { return kInitialised < 0 ? 1 : 0; }
