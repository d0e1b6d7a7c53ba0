#include <string>
#include <vector>

#include "app/run.h"

int main(int count, char** words) {
  return static_cast<int>(
      lightvane::runCommandLine(std::vector<std::string>(words + (count > 0 ? 1 : 0), words + count)));
}
