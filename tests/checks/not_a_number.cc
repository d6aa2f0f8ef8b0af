// the kernels of a law use intrinsics in which GCC finds uninitialized numbers
#pragma GCC diagnostic ignored "-Wuninitialized"

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/spectral.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const double nan = std::numeric_limits<double>::quiet_NaN();

    /** The output of an action. */
    std::string
    printed(const std::function<void()> &action)
    {
      std::ostringstream    text;
      std::streambuf *const terminal = std::cout.rdbuf(text.rdbuf());
      try
        {
          action();
        }
      catch (...)
        {
          std::cout.rdbuf(terminal);
          throw;
        }
      std::cout.rdbuf(terminal);
      return text.str();
    }


    bool
    is_wrong(const std::string &text)
    {
      return text.find("WRONG") != std::string::npos &&
             text.find("  ok") == std::string::npos;
    }


    /** A law that returns NaN while the strain is large, and numbers again when
     *  the strain becomes smaller. */
    struct NotANumber : IsotropicElasticity
    {
      static constexpr unsigned int n_history = 1;
      static constexpr double       limit     = 1e-3;

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress, const Number &) const
      {
        return strain(stress).norm() / limit;
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number *,
              const PointSituation<Number> &) const
      {
        const Number factor =
          compare_and_apply_mask<SIMDComparison::greater_than>(strain.norm(),
                                                               Number(limit),
                                                               Number(nan),
                                                               Number(1.));
        PointResponse<Number> response(strain);
        response.stress            = factor * stress(strain);
        response.dissipation       = factor - 1.;
        response.plastic_increment = (factor - 1.) * strain;
        return response;
      }
    };


    /** The verdicts themselves: NaN must never pass. */
    class NotANumberCheck : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        evaluate_verdicts(verdicts, communicator);
        evaluate_extremes(verdicts);
        evaluate_entries(verdicts, communicator);
        evaluate_spectra(verdicts);
        evaluate_materials(file, verdicts, communicator);
      }

    private:
      static void
      evaluate_verdicts(Verdicts &verdicts, const MPI_Comm communicator)
      {
        Verdicts   tried(communicator);
        const auto expect = [&](const std::string           &name,
                                const std::function<void()> &action) {
          verdicts.is_true(name, is_wrong(printed(action)));
        };
        expect("near: the value", [&] { tried.near("", nan, 1., 1.); });
        expect("near: the reference", [&] { tried.near("", 1., nan, 1.); });
        expect("near: both", [&] { tried.near("", nan, nan, 1.); });
        expect("near: the tolerance", [&] { tried.near("", 1., 1., nan); });
        expect("below: the value", [&] { tried.below("", nan, 1.); });
        expect("below: the limit", [&] { tried.below("", 0., nan); });
        expect("above: the value", [&] { tried.above("", nan, -1.); });
        expect("above: the limit", [&] { tried.above("", 0., nan); });
      }

      static void
      evaluate_extremes(Verdicts &verdicts)
      {
        double largest = 0., smallest = 0.;
        for (const double value : {1., nan, 2., -2.})
          {
            keep_largest(largest, value);
            keep_smallest(smallest, value);
          }
        verdicts.is_true("keep_largest keeps it", std::isnan(largest));
        verdicts.is_true("keep_smallest keeps it", std::isnan(smallest));
        verdicts.is_true("positive_part keeps it",
                         std::isnan(positive_part(nan)));
        // and valid numbers pass
        largest = smallest = 0.;
        for (const double value : {1., 3., -2., 2.})
          {
            keep_largest(largest, value);
            keep_smallest(smallest, value);
          }
        verdicts.is_true("keep_largest of numbers", largest == 3.);
        verdicts.is_true("keep_smallest of numbers", smallest == -2.);
        verdicts.is_true("positive_part of numbers",
                         positive_part(2.) == 2. && positive_part(-2.) == 0.);
      }

      /** Pressures that differ by round-off in their directions. */
      static void
      evaluate_spectra(Verdicts &verdicts)
      {
        double worst = 0.;
        for (const double pressure : {1., -1.1, 1.2e6, -3.7e7, 1e-9})
          for (unsigned int changes = 0; changes < 27; ++changes)
            {
              SymmetricTensor3<double> tensor;
              for (unsigned int d = 0, rest = changes; d < 3; ++d, rest /= 3)
                {
                  const double towards[] = {pressure, 0., 2. * pressure};
                  tensor[d][d] = std::nextafter(pressure, towards[rest % 3]);
                }
              const auto found = spectrum(tensor);
              for (unsigned int k = 0; k < 3; ++k)
                {
                  keep_largest(worst,
                               std::abs(found.values[k] / pressure - 1.));
                  keep_largest(worst,
                               std::abs(found.directions[k].norm() - 1.));
                }
            }
        verdicts.below("spectrum of a pressure to round-off", worst, 1e-14);
      }

      static void
      evaluate_entries(Verdicts &verdicts, const MPI_Comm communicator)
      {
        // on the last rank only; with a larger number after it
        const unsigned int rank =
                             Utilities::MPI::this_mpi_process(communicator),
                           n = Utilities::MPI::n_mpi_processes(communicator);
        IndexSet owned(3 * n);
        owned.add_range(3 * rank, 3 * rank + 3);
        Vector vector(owned, communicator);
        for (const unsigned int place : {0, 1, 2})
          {
            vector = -1.;
            if (rank == n - 1)
              vector.local_element(place) = nan;
            const double largest = largest_entry(vector);
            verdicts.is_true("largest_entry keeps number " +
                               std::to_string(place),
                             std::isnan(largest));
          }
        vector                  = -1.;
        vector.local_element(1) = -4. * (rank + 1);
        verdicts.near("largest_entry of numbers",
                      largest_entry(vector),
                      4. * n,
                      0.);
      }

      /** The check of all materials, with such a law as the only one. */
      static void
      evaluate_materials(const ParameterFile &file,
                         Verdicts            &verdicts,
                         const MPI_Comm       communicator)
      {
        auto      &entries = Registry<Material>::entries();
        const auto known   = entries;
        entries.clear();
        // under the name that is the default of every material
        entries["linear elastic"] = {
          "No number beyond a strain.",
          [] { return std::make_unique<MaterialOf<NotANumber>>(); }};
        const std::string text = printed([&] {
          Verdicts of_the_law(communicator);
          Registry<Check>::create("materials", "")
            ->run(file, of_the_law, communicator);
        });
        entries                = known;
        std::istringstream lines(text);
        bool               small = true;
        for (std::string line; std::getline(lines, line);)
          {
            const std::string name  = line.substr(0, line.find(" below"));
            const bool        patch = name.find("patch") != name.npos;
            // elastic waves, and the first of the patches has a small strain
            const bool elastic =
              name.find("waves") != name.npos || (patch && small);
            small = small && !patch;
            verdicts.is_true(name + (elastic ? ": good" : ": wrong"),
                             is_wrong(line) != elastic);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<NotANumberCheck> registered("not a number",
                                                           "Verdicts on NaN.");
  } // namespace
} // namespace Voussoir
