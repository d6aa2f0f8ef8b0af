#include <voussoir/grid/partition_counts.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A cube of 4 x 4 x 4 cells distributed to eight ranks: each has an eighth.
     * Between two of them lie 12 faces of 4 nodes, 6 edges of 2 nodes at four
     * ranks, and the middle at all; the first rank exchanges 12 + 3 * 6 + 7 of
     * these nodes.
     */
    class CountedPartition : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const PartitionCounts counts =
          simulation->model.grid.partition_counts().at(0);
        verdicts.near("largest load over the mean", counts.balance, 1., 1e-14);
        // the first with all, the next three at an edge with three, then faces
        verdicts.near("neighbours of a rank",
                      counts.neighbours,
                      2. * (7. + 3. * 3. + 3.) / 8.,
                      1e-14);
        verdicts.near("most", counts.most_neighbours, 7., 0.);
        verdicts.near("nodes that a rank exchanges",
                      counts.nodes,
                      2. * (12. * 4. + 6. * 2. * 3. + 7.) / 8.,
                      1e-14);
        verdicts.near("most", counts.most_nodes, 12. + 18. + 7., 0.);
        verdicts.near("cells without these", counts.inner, 0.125, 1e-14);
        verdicts.near("least", counts.least_inner, 0.125, 1e-14);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<CountedPartition>
      registered("counted partition", "Exchange of partitions.");
  } // namespace
} // namespace Voussoir
