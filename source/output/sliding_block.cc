#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/output/sliding_block.h>
#include <voussoir/signals/record.h>

#include <algorithm>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The side of a surface on which a block lies: 1 if on the second, -1 if
     *  on the first. */
    double
    side_of(const std::string &block,
            const std::string &surface,
            const Grid        &grid,
            const std::string &place)
    {
      // numbers of the faces of the first side, and of those of the block
      std::vector<double>     sums(2);
      const std::vector<bool> of_block = grid.tags_in({block});
      grid.for_each_face(surface, [&](const auto &cell, const unsigned int) {
        sums[0] += 1.;
        sums[1] += of_block[cell->material_id()] ? 1. : 0.;
      });
      grid.for_each_face(surface + other_side,
                         [&](const auto &cell, const unsigned int) {
                           sums[1] -= of_block[cell->material_id()] ? 1. : 0.;
                         });
      sums = sum_over_ranks(sums, grid.communicator());
      if (std::abs(sums[1]) != sums[0])
        throw UserError(place + ": the surface \"" + surface +
                        "\" does not separate the cell set \"" + block +
                        "\" from other cells; choose the surfaces on which the "
                        "block rests.");
      return sums[1] < 0. ? 1. : -1.;
    }


    /** Sum of the normals of a surface's points times their areas [m2], into
     *  its second side. */
    Tensor<1, 3>
    normal_area(const unsigned int surface,
                const Contact     &contact,
                const MPI_Comm     communicator)
    {
      Tensor<1, 3> sum;
      for (const ContactPoint &point : contact.points())
        if (point.surface == surface)
          sum += point.area * point.frame[0];
      return Utilities::MPI::sum(sum, communicator);
    }
  } // namespace


  std::vector<SlidingBlock>
  find_sliding_blocks(const std::string &text,
                      const std::string &place,
                      const Solid       &solid,
                      const Contact     &contact)
  {
    const Grid               &grid  = solid.grid();
    const auto               &names = contact.surface_names();
    std::vector<SlidingBlock> blocks;
    for (const std::string &item : split_list(text, ';'))
      {
        const auto   colon = item.find(':');
        SlidingBlock block;
        block.name = Utilities::trim(item.substr(0, colon));
        if (colon == std::string::npos)
          throw UserError(place + ": \"" + item +
                          "\" is no block; write \"cell set: surface, "
                          "surface\", several separated by \";\".");
        grid.check_cell_set(block.name, place);
        for (const std::string &name : split_list(item.substr(colon + 1)))
          {
            const auto found = std::find(names.begin(), names.end(), name);
            if (found == names.end())
              throw UserError(place + " names \"" + name +
                              "\", which is no surface of an interface; list "
                              "it in section \"Interfaces\".");
            const unsigned int surface = found - names.begin();
            const double       side    = side_of(block.name, name, grid, place);
            const Tensor<1, 3> normal =
              normal_area(surface, contact, grid.communicator());
            block.planes.push_back(
              {surface, side, side / normal.norm() * normal});
          }
        const std::vector<bool> inside = grid.tags_in({block.name});
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned() && inside[cell->material_id()])
            {
              const Material &material = solid.material_of(cell);
              block.volume += cell->measure();
              block.weight +=
                standard_gravity * cell->measure() * material.density;
              block.mass += cell->measure() * material.inertial_density();
            }
        for (double *sum : {&block.volume, &block.weight, &block.mass})
          *sum = Utilities::MPI::sum(*sum, grid.communicator());
        blocks.push_back(block);
      }
    return blocks;
  }


  double
  sliding_safety(const std::vector<SlidingPlane> &planes,
                 const Tensor<1, 3>              &force)
  {
    constexpr double infinity  = std::numeric_limits<double>::infinity();
    constexpr double tolerance = 1e-9;

    if (std::all_of(planes.begin(), planes.end(), [&](const auto &plane) {
          return force * plane.normal < 0.;
        }))
      return 0.;

    const std::size_t n        = planes.size();
    double            smallest = infinity;
    const auto        consider = [&](const Tensor<1, 3> &against,
                              const double        resistance,
                              const std::size_t   i,
                              const std::size_t   j) {
      // without a driving force, or with nearly none
      const double driving = against.norm();
      if (driving <= 1e-6 * std::max(resistance, force.norm()))
        return;
      for (std::size_t k = 0; k < n; ++k)
        if (k != i && k != j &&
            -against * planes[k].normal < -tolerance * driving)
          return;
      smallest = std::min(smallest, resistance / driving);
    };

    for (std::size_t i = 0; i < n; ++i)
      {
        const SlidingPlane &a  = planes[i];
        const double        Na = force * a.normal;
        if (Na > 0.)
          consider(force - Na * a.normal, a.friction * Na + a.cohesion, i, i);
        for (std::size_t j = i + 1; j < n; ++j)
          {
            const SlidingPlane &b      = planes[j];
            const double        Nb     = force * b.normal;
            const double        cosine = a.normal * b.normal,
                         sine2         = 1. - cosine * cosine;
            if (sine2 < tolerance)
              continue;
            const double Ni = (Na - cosine * Nb) / sine2,
                         Nj = (Nb - cosine * Na) / sine2;
            if (Ni >= 0. && Nj >= 0.)
              consider(force - Ni * a.normal - Nj * b.normal,
                       a.friction * Ni + a.cohesion + b.friction * Nj +
                         b.cohesion,
                       i,
                       j);
          }
      }
    return smallest;
  }


  bool
  SafetyHistory::add(const double time,
                     const double interval,
                     const double safety)
  {
    if (std::isnan(at_start))
      at_start = safety;
    const bool is_smallest = safety < smallest;
    if (is_smallest)
      {
        smallest         = safety;
        time_of_smallest = time;
      }
    // sliding planes are at their limit, apart from waves inside the block
    if (safety < 1. + 1e-3)
      time_at_one += interval;
    return is_smallest;
  }


  nlohmann::json
  SafetyHistory::summary() const
  {
    return {{"safety at the start", at_start},
            {"smallest safety", smallest},
            {"time of the smallest safety [s]", time_of_smallest},
            {"time at safety one or below [s]", time_at_one}};
  }


  std::array<double, 4>
  SafetyHistory::save() const
  {
    return {{json_number(at_start),
             json_number(smallest),
             time_of_smallest,
             time_at_one}};
  }


  void
  SafetyHistory::load(const std::array<double, 4> &saved)
  {
    at_start         = from_json_number(saved[0]);
    smallest         = from_json_number(saved[1]);
    time_of_smallest = saved[2];
    time_at_one      = saved[3];
  }


  double
  json_number(const double value)
  {
    return std::min(value, std::numeric_limits<double>::max());
  }


  double
  from_json_number(const double value)
  {
    return value == std::numeric_limits<double>::max() ?
             std::numeric_limits<double>::infinity() :
             value;
  }
} // namespace Voussoir
