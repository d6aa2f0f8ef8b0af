#ifndef voussoir_analysis_static_outline_h
#define voussoir_analysis_static_outline_h

#include <voussoir/analysis/static_state.h>

namespace Voussoir
{
  /** The summary of the static state with all its keys, and numbers without
   *  meaning, before that state is found. Called on all ranks. */
  nlohmann::json
  outline_of_static_state(const StaticModel      &model,
                          const StaticParameters &parameters,
                          const NamedLoads       &loads);
} // namespace Voussoir

#endif
