#include "apps/cpu_features.h"

// A macro that is defined spells "1", another one its own name.
#define ALHAZEN_SPELL(macro) #macro
#define ALHAZEN_IS_SET(macro, name) ALHAZEN_SPELL(macro)[0] == '1',

extern "C" constinit const bool alhazen_built_for[] = {ALHAZEN_FOR_EACH_CPU_FEATURE(ALHAZEN_IS_SET)};
