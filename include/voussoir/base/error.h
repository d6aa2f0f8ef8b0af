#ifndef voussoir_base_error_h
#define voussoir_base_error_h

#include <stdexcept>
#include <string>

namespace Voussoir
{
  /**
   * A mistake in the user's input (parameters, mesh, record). The text is
   * one plain sentence that names the place and the remedy; the program prints
   * it on the first rank and ends with exit code 1.
   */
  class UserError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * A static stage without equilibrium, or a run whose energy balance is
   * violated: an outcome of the case, which a criterion of a study may name.
   */
  class RunStopped : public UserError
  {
  public:
    using UserError::UserError;
  };
} // namespace Voussoir

#endif
