#include <string>
#include <vector>

#include "app/run.h"
#include "core/base/freed_memory.h"

int main(int count, char** words) {
  lightvane::keepFreedMemory();
  return static_cast<int>(
      lightvane::runCommandLine(std::vector<std::string>(words + (count > 0 ? 1 : 0), words + count)));
}
