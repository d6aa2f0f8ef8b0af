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
        prm.add_parameter("Modulus", modulus, "E [Pa].");
        prm.add_parameter("Static factor", static_factor, "k.");
        prm.add_parameter("Strength increase", increase, "Of the earthquake.");
        prm.add_parameter("Fracture energy", fracture_energy, "[N/m]");
        prm.add_parameter("Tensile strength", tensile_strength, "[Pa]");
        prm.add_parameter("Crushing energy", crushing_energy, "[N/m]");
        prm.add_parameter("Compressive strength", compressive_strength, "[Pa]");
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
        const double crack =
          1.8 * modulus * fracture_energy / square(tensile_strength);
        const double crushing =
          1.8 * modulus * crushing_energy /
          (square(compressive_strength) * (1. - square(residual)));

        verdicts.is_true("crushing",
                         has(clause_of(crushing / increase, "crushing")));
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
      static double
      square(const double x)
      {
        return x * x;
      }

      std::string
      clause_of(const double limit, const std::string &what) const
      {
        std::ostringstream text;
        text << std::setprecision(3) << "cells of up to " << length
             << " m are longer than " << limit << " m, beyond which " << what
             << " would snap back;";
        return text.str();
      }

      double length = 3., small_length = 0.5, modulus = 30e9,
             static_factor = 0.6, increase = 1.2, fracture_energy = 350.,
             tensile_strength = 2e6, crushing_energy = 30e3,
             compressive_strength = 25e6, residual = 0.05;
    };

    // Reference: closed form
    const Registry<Check>::Add<NoteOfLargeCells>
      registered("note of large cells",
                 "Lengths of cells beyond which failure would snap back.");
  } // namespace
} // namespace Voussoir
