#include <voussoir/grid/partition_counts.h>

#include <algorithm>
#include <numeric>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    PartitionCounts
    counts_of(const ParameterFile &file, const MPI_Comm communicator)
    {
      const auto parameters = make_case(file);
      const auto simulation = make_simulation(*parameters, communicator);
      return simulation->model.grid.partition_counts().at(0);
    }


    template <typename Number>
    double
    sum(const std::vector<Number> &values)
    {
      return std::accumulate(values.begin(), values.end(), 0.);
    }


    template <typename Number>
    double
    largest(const std::vector<Number> &values)
    {
      return *std::max_element(values.begin(), values.end());
    }


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
        const auto counts = counts_of(file, communicator);
        verdicts.near("largest load over the mean",
                      largest(counts.load),
                      1.,
                      1e-14);
        // the first with all, the next three at an edge with three, then faces
        verdicts.near("neighbours of all ranks",
                      sum(counts.neighbours),
                      2. * (7. + 3. * 3. + 3.),
                      1e-14);
        verdicts.near("most", largest(counts.neighbours), 7., 0.);
        verdicts.near("nodes that all ranks exchange",
                      sum(counts.nodes),
                      2. * (12. * 4. + 6. * 2. * 3. + 7.),
                      1e-14);
        verdicts.near("most", largest(counts.nodes), 12. + 18. + 7., 0.);
        verdicts.near("sum of the parts of their cells without these",
                      sum(counts.inner),
                      8. * 0.125,
                      1e-14);
        verdicts.near("largest", largest(counts.inner), 0.125, 1e-14);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<CountedPartition>
      registered("counted partition", "Exchange of partitions.");


    /** A bar of 2 x 2 x 8 cells distributed to two ranks: they share the nine
     *  nodes of the cross section in the middle, at four of 16 cells each. */
    class CountedHalves : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto counts = counts_of(file, communicator);
        for (unsigned int rank = 0; rank < 2; ++rank)
          {
            verdicts.near("load over the mean",
                          counts.load.at(rank),
                          1.,
                          1e-14);
            verdicts.near("neighbours", counts.neighbours[rank], 1., 0.);
            verdicts.near("nodes that it exchanges",
                          counts.nodes[rank],
                          9.,
                          0.);
            verdicts.near("part of its cells without these",
                          counts.inner[rank],
                          0.75,
                          1e-14);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<CountedHalves>
      halves_registered("counted halves", "Exchange of two halves of a bar.");


    /** A column of ten layers of as many cells, with absorbing ends and a joint
     *  below the third layer: the costs of the layers are 2, 2, 2, 1, ..., 1,
     * 2, so that the halves of two ranks are four and six layers. */
    class CountedFaces : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Nodes of a level", nodes, "Number of them.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto counts = counts_of(file, communicator);
        verdicts.near("largest load over the mean",
                      largest(counts.load),
                      1.,
                      1e-14);
        verdicts.near("nodes that the first exchanges",
                      counts.nodes.at(0),
                      nodes,
                      0.);
        verdicts.near("sum of the parts of their cells without these",
                      sum(counts.inner),
                      3. / 4. + 5. / 6.,
                      1e-14);
      }

    private:
      double nodes = 4.;
    };

    // Reference: closed form
    const Registry<Check>::Add<CountedFaces> faces_registered(
      "counted faces",
      "Load of ranks along a column with absorbing ends and a joint.");
  } // namespace
} // namespace Voussoir
