#include <voussoir/analysis/eigensolver.h>
#include <voussoir/base/error.h>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <AnasaziLOBPCGSolMgr.hpp>
#include <Epetra_MultiVector.h>
#include <Teuchos_oblackholestream.hpp>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    void
    copy(const double *from, Vector &to)
    {
      std::copy(from, from + to.locally_owned_size(), to.begin());
    }


    /** An operator for the vectors of a block, one after the other. */
    struct BlockOperator
    {
      const Eigenproblem::Operator &apply;
      const Vector                 &layout;

      void
      operator()(const Epetra_MultiVector &from, Epetra_MultiVector &to) const
      {
        Vector x(layout), y(layout);
        for (int j = 0; j < from.NumVectors(); ++j)
          {
            copy(from[j], x);
            apply(y, x);
            std::copy(y.begin(), y.end(), to[j]);
          }
      }
    };
  } // namespace
} // namespace Voussoir


namespace Anasazi
{
  template <>
  class OperatorTraits<double, Epetra_MultiVector, Voussoir::BlockOperator>
  {
  public:
    static void
    Apply(const Voussoir::BlockOperator &apply,
          const Epetra_MultiVector      &from,
          Epetra_MultiVector            &to)
    {
      apply(from, to);
    }
  };
} // namespace Anasazi


namespace Voussoir
{
  namespace
  {
    using Block  = Epetra_MultiVector;
    using Solver = Anasazi::LOBPCG<double, Block, BlockOperator>;

    std::vector<double>
    norms(const Block &block)
    {
      std::vector<double> result(block.NumVectors());
      block.Norm2(result.data());
      return result;
    }


    /** Passes those whose residual is small against the stiffness term. */
    class ResidualTest
      : public Anasazi::StatusTest<double, Block, BlockOperator>
    {
    public:
      explicit ResidualTest(const double tolerance)
        : tolerance(tolerance)
      {}

      Anasazi::TestStatus
      checkStatus(
        Anasazi::Eigensolver<double, Block, BlockOperator> *solver) override
      {
        const auto state     = dynamic_cast<Solver *>(solver)->getState();
        const auto residual  = norms(*state.R);
        const auto stiffness = norms(*state.MX);
        passed.clear();
        for (unsigned int j = 0; j < residual.size(); ++j)
          if (residual[j] <= tolerance * (*state.T)[j] * stiffness[j])
            passed.push_back(j);
        status =
          passed.size() == residual.size() ? Anasazi::Passed : Anasazi::Failed;
        return status;
      }

      Anasazi::TestStatus
      getStatus() const override
      {
        return status;
      }

      std::vector<int>
      whichVecs() const override
      {
        return passed;
      }

      int
      howMany() const override
      {
        return passed.size();
      }

      void
      reset() override
      {
        clearStatus();
      }

      void
      clearStatus() override
      {
        passed.clear();
        status = Anasazi::Undefined;
      }

      std::ostream &
      print(std::ostream &out, int) const override
      {
        return out;
      }

    private:
      const double        tolerance;
      std::vector<int>    passed;
      Anasazi::TestStatus status = Anasazi::Undefined;
    };
  } // namespace


  Eigenpairs
  find_lowest(const Eigenproblem        &problem,
              const std::vector<Vector> &start,
              const unsigned int         number,
              const double               tolerance)
  {
    using Teuchos::rcp;
    const Vector    &layout = start.at(0);
    const Epetra_Map map    = layout.locally_owned_elements().make_trilinos_map(
      layout.get_mpi_communicator());
    const auto block = rcp(new Block(map, start.size()));
    for (unsigned int j = 0; j < start.size(); ++j)
      std::copy(start[j].begin(), start[j].end(), (*block)[j]);

    using Problem = Anasazi::BasicEigenproblem<double, Block, BlockOperator>;
    const auto anasazi =
      rcp(new Problem(rcp(new BlockOperator{problem.mass, layout}),
                      rcp(new BlockOperator{problem.stiffness, layout}),
                      block));
    anasazi->setPrec(rcp(new BlockOperator{problem.precondition, layout}));
    anasazi->setHermitian(true);
    anasazi->setNEV(number);
    anasazi->setProblem();

    Teuchos::ParameterList list;
    list.set("Which", "LR");
    list.set("Block Size", int(start.size()));
    list.set("Maximum Iterations", 500);
    list.set("Output Stream",
             Teuchos::fancyOStream(
               Teuchos::RCP<std::ostream>(new Teuchos::oblackholestream)));
    Anasazi::LOBPCGSolMgr<double, Block, BlockOperator> solver(anasazi, list);
    const auto sorter = rcp(new Anasazi::BasicSort<double>("LR"));
    solver.setGlobalStatusTest(
      rcp(new Anasazi::StatusTestWithOrdering<double, Block, BlockOperator>(
        rcp(new ResidualTest(tolerance)), sorter, number)));

    bool converged = false;
    try
      {
        converged = solver.solve() == Anasazi::Converged;
      }
    catch (const Anasazi::AnasaziError &)
      {} // the vectors have become dependent
    if (!converged)
      throw UserError("The natural modes do not converge, which they do not "
                      "when a part of the model can move freely; hold it with "
                      "\"Fixed\" or \"Roller\" in section \"Boundaries\", or "
                      "ask for fewer modes in section \"Modes\".");

    Eigenpairs result;
    result.iterations    = solver.getNumIters();
    const auto &solution = anasazi->getSolution();
    Vector      stiffness(layout), mass(layout);
    for (int j = 0; j < solution.numVecs; ++j)
      {
        const double theta = solution.Evals[j].realpart;
        Vector       x(layout);
        copy((*solution.Evecs)[j], x);
        x /= std::sqrt(theta); // from x^T K x = 1
        problem.stiffness(stiffness, x);
        problem.mass(mass, x);
        const double size = stiffness.l2_norm();
        stiffness.add(-1. / theta, mass);
        result.values.push_back(1. / theta);
        result.residuals.push_back(stiffness.l2_norm() / size);
        result.vectors.push_back(x);
      }
    return result;
  }
} // namespace Voussoir
