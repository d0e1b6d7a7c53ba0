#include "app/version.h"

namespace lightvane {

const char* versionText() { return LIGHTVANE_VERSION; }

}  // namespace lightvane
