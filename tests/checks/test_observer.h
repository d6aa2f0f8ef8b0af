#ifndef voussoir_tests_test_observer_h
#define voussoir_tests_test_observer_h

#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** An observer that acts on a run, for tests. */
  class TestObserver : public Observer
  {
  public:
    void
    prepare() override
    {}

    void
    conclude(const State &, nlohmann::json &) override
    {}
  };
} // namespace Voussoir

#endif
