#ifndef voussoir_fem_trilinear_cells_h
#define voussoir_fem_trilinear_cells_h

#include <voussoir/fem/eight_point_shape.h>
#include <voussoir/fem/one_point_shape.h>
#include <voussoir/fem/single_nodes.h>

#include <deal.II/matrix_free/fe_evaluation.h>

namespace Voussoir
{
  /** Trilinear cells of a batch, in place of FEEvaluation. */
  template <template <typename> class Shape>
  class TrilinearCells : public Shape<Lanes>
  {
  public:
    using MatrixFree = Discretization::MatrixFree;

    explicit TrilinearCells(const MatrixFree &matrix_free)
      : Shape<Lanes>(matrix_free)
      , nodes(matrix_free)
    {}

    static constexpr unsigned int dofs_per_cell = 24;

    void
    reinit(const unsigned int batch);

    void
    read_dof_values(const Vector &vector)
    {
      nodes.read_dof_values(vector);
    }

    Lanes *
    begin_dof_values()
    {
      return nodes.begin_dof_values();
    }

    /** Evaluates gradients or values, according to the flags. */
    void
    evaluate(const dealii::EvaluationFlags::EvaluationFlags flags)
    {
      if (flags & dealii::EvaluationFlags::values)
        this->evaluate_values(begin_dof_values());
      else
        this->evaluate_gradients(begin_dof_values());
    }

    void
    gather_evaluate(const Vector                                  &vector,
                    const dealii::EvaluationFlags::EvaluationFlags flags)
    {
      read_dof_values(vector);
      evaluate(flags);
    }

    void
    integrate(const dealii::EvaluationFlags::EvaluationFlags)
    {
      this->integrate_gradients(begin_dof_values());
    }

    void
    distribute_local_to_global(Vector &vector)
    {
      nodes.distribute_local_to_global(vector);
    }

    void
    integrate_scatter(const dealii::EvaluationFlags::EvaluationFlags flags,
                      Vector                                        &vector)
    {
      integrate(flags);
      distribute_local_to_global(vector);
    }

  private:
    BatchNodes nodes;
  };


  /** Trilinear cells of one or two batches in single precision. */
  template <template <typename> class Shape>
  class SingleTrilinearCells : public Shape<Singles>
  {
  public:
    explicit SingleTrilinearCells(const Discretization::MatrixFree &matrix_free)
      : Shape<Singles>(matrix_free)
      , nodes(matrix_free)
    {}

    /** @p n batches from @p batch on. */
    void
    reinit(const unsigned int batch, const unsigned int n)
    {
      nodes.reinit(batch, n);
      nodes.read_corners(values);
      Shape<Singles>::reinit(values);
    }

    /** Evaluates the gradient of SingleNodes::read(vectors...). */
    template <typename... Vectors>
    void
    gather_evaluate(const Vectors &...vectors)
    {
      nodes.read(values, vectors...);
      this->evaluate_gradients(values.data());
    }

    void
    integrate()
    {
      this->integrate_gradients(values.data());
    }

    /** Forces at the nodes of the first batch (@p half 0) or of the second
     *  one. */
    Lanes
    force(const unsigned int i, const unsigned int half) const
    {
      return half_of_singles(values[i], half);
    }

    void
    distribute_local_to_global(Vector &vector)
    {
      nodes.add_to(vector, values);
    }

    void
    distribute_half(Vector &vector, const unsigned int half)
    {
      nodes.add_half(vector, values, half);
    }

  private:
    SingleNodes         nodes;
    SingleNodes::Values values;
  };
} // namespace Voussoir

#endif
