#include "same.h"

#include <fstream>

namespace Voussoir
{
  using namespace dealii;

  bool
  same(const Vector &a, const Vector &b)
  {
    const bool here =
      std::equal(a.begin(), a.begin() + a.locally_owned_size(), b.begin());
    return Utilities::MPI::min(here ? 1 : 0, a.get_mpi_communicator()) == 1;
  }


  bool
  same(const KeyedValues &a, const KeyedValues &b, const MPI_Comm communicator)
  {
    bool                here = a.items.size() == b.items.size();
    std::vector<double> of_a, of_b;
    for (std::size_t i = 0; here && i < a.items.size(); ++i)
      {
        const double *row = a.row(i, of_a);
        here              = a.items[i].first == b.items[i].first &&
               std::equal(row, row + a.width, b.row(i, of_b));
      }
    return Utilities::MPI::min(here ? 1 : 0, communicator) == 1;
  }


  std::string
  text_of(const std::string &file)
  {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }
} // namespace Voussoir
