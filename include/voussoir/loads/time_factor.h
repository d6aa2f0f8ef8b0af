#ifndef voussoir_loads_time_factor_h
#define voussoir_loads_time_factor_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>

namespace Voussoir
{
  /** A factor over time that the user writes as a formula in t. */
  class TimeFactor
  {
  public:
    /** @param expression default; empty: the factor is optional */
    explicit TimeFactor(const std::string &expression = "1")
      : expression(expression)
    {}

    /** Whether there is a factor. */
    bool
    given() const
    {
      return !expression.empty();
    }

    /** Declares the entry. */
    void
    declare(dealii::ParameterHandler &prm,
            const std::string        &entry,
            const std::string        &description);

    /** Refuses text that is no formula; @p place names section and entry. */
    void
    prepare(const std::string &place);

    double
    operator()(const double time) const;

  private:
    std::string                                expression;
    std::unique_ptr<dealii::FunctionParser<1>> function;
  };
} // namespace Voussoir

#endif
