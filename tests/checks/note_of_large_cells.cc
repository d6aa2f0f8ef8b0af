#include <voussoir/base/parse_numbers.h>

#include <iomanip>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Note on cells in which a crack or crushing would snap back: beyond the
     *  length 1.8 k E G / (f^2 - r^2) with the modulus k E, the strength f and
     * the residual strength r, in the earthquake and in the static state. */
    class NoteOfLargeCells : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length", length, "Of the cells [m].");
        prm.add_parameter("Small length", small_length, "Without a note [m].");
        prm.add_parameter("Residual strength",
                          residual,
                          "In compression, share of the strength.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto      parameters = make_case(file);
        const auto      simulation = make_simulation(*parameters, communicator);
        const Material &material   = *simulation->model.solid.materials[0];
        const std::string note     = material.remark(length);
        const auto        has      = [&](const std::string &clause) {
          return note.find(clause) != std::string::npos;
        };
        const auto of_concrete = [&](const std::string &entry) {
          return parse_number(file.given("Materials/concrete/" + entry))
            .value();
        };
        const auto limit = [&](const std::string &energy,
                               const std::string &strength,
                               const double       share_left) {
          return 1.8 * of_concrete("Young's modulus") * of_concrete(energy) /
                 (Utilities::fixed_power<2>(of_concrete(strength)) *
                  (1. - Utilities::fixed_power<2>(share_left)));
        };
        const double static_factor = of_concrete("Static factor");
        const double crack = limit("Fracture energy", "Tensile strength", 0.),
                     crushing = limit("Crushing energy",
                                      "Compressive strength",
                                      residual);

        verdicts.is_true("crushing",
                         has(clause_of(crushing /
                                         of_concrete("Strength increase"),
                                       "crushing")));
        verdicts.is_true("a crack in the static state",
                         has("in the static state " +
                             clause_of(static_factor * crack, "a crack")));
        verdicts.is_true("crushing in the static state",
                         has("and " +
                             clause_of(static_factor * crushing, "crushing")));
        verdicts.is_true("one sentence",
                         note.find(". ") == std::string::npos &&
                           note.back() == '.');
        verdicts.is_true("small cells: no note",
                         material.remark(small_length).empty());
      }

    private:
      std::string
      clause_of(const double limit, const std::string &what) const
      {
        std::ostringstream text;
        text << std::setprecision(3) << "cells of up to " << length
             << " m are longer than " << limit << " m, beyond which " << what
             << " would snap back;";
        return text.str();
      }

      double length = 3., small_length = 0.5, residual = 0.05;
    };

    // Reference: closed form
    const Registry<Check>::Add<NoteOfLargeCells>
      registered("note of large cells",
                 "Lengths of cells beyond which failure would snap back.");
  } // namespace
} // namespace Voussoir
