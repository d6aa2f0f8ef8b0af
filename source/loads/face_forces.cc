#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/face_forces.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Gauss points for the unit square in the two parts into which a bilinear
     * function cuts it, given by its values at the corners: exact where the cut
     * is straight, as on faces that are parallelograms.
     */
    Quadrature<2>
    cut_quadrature(const std::array<double, 4> &corners,
                   const unsigned int           n_points)
    {
      // h(s, t) = a + b s + c t + d s t, with t the direction of steeper change
      const double a = corners[0], d = corners[3] - corners[1] - corners[2] + a;
      double       b = corners[1] - a, c = corners[2] - a;
      const bool   exchanged = std::abs(b + 0.5 * d) > std::abs(c + 0.5 * d);
      if (exchanged)
        std::swap(b, c);

      // the cut leaves the square through t = 0 or t = 1 at these s
      std::vector<double> ends{0., 1.};
      for (const double s : {-a / b, -(a + c) / (b + d)})
        if (s > 0. && s < 1.)
          ends.push_back(s);
      std::sort(ends.begin(), ends.end());

      const QGauss<1>       gauss(n_points);
      std::vector<Point<2>> points;
      std::vector<double>   weights;
      for (unsigned int i = 0; i + 1 < ends.size(); ++i)
        for (unsigned int p = 0; p < n_points; ++p)
          {
            const double width = ends[i + 1] - ends[i];
            const double s     = ends[i] + width * gauss.point(p)[0];
            const double cut   = -(a + b * s) / (c + d * s);
            const double split = cut > 0. && cut < 1. ? cut : 0.;
            for (const auto &[begin, end] :
                 {std::make_pair(0., split), std::make_pair(split, 1.)})
              if (end > begin)
                for (unsigned int q = 0; q < n_points; ++q)
                  {
                    const double t = begin + (end - begin) * gauss.point(q)[0];
                    points.push_back(exchanged ? Point<2>(t, s) :
                                                 Point<2>(s, t));
                    weights.push_back(width * gauss.weight(p) * (end - begin) *
                                      gauss.weight(q));
                  }
          }
      return Quadrature<2>(points, weights);
    }


    /** The integrals of a traction times the shape functions over faces. */
    class TractionIntegrals
    {
    public:
      TractionIntegrals(const Discretization &discretization,
                        const Traction       &traction,
                        const double          kink)
        : discretization(discretization)
        , scalar(discretization.fe.base_element(0))
        , traction(traction)
        , kink(kink)
        , whole_face(discretization.mapping,
                     scalar,
                     QGauss<2>(discretization.degree + 1),
                     flags)
        , corners(discretization.mapping,
                  scalar,
                  QTrapezoid<2>(),
                  update_quadrature_points)
      {}

      void
      add_face(const Triangulation<3>::active_cell_iterator &cell,
               const unsigned int                            face)
      {
        corners.reinit(cell, face);
        std::array<double, 4> above;
        for (unsigned int v = 0; v < 4; ++v)
          above[v] = corners.quadrature_point(v)[2] - kink;
        const auto [lowest, highest] =
          std::minmax_element(above.begin(), above.end());
        // a level at the edge of a face, but for round-off, does not cut it
        const double round_off = 1e-10 * cell->face(face)->diameter();
        if (*lowest<-round_off && * highest> round_off)
          {
            FEFaceValues<3> two_parts(discretization.mapping,
                                      scalar,
                                      cut_quadrature(above,
                                                     discretization.degree + 3),
                                      flags);
            integrate(two_parts, cell, face);
          }
        else
          integrate(whole_face, cell, face);
      }

      std::vector<NodalForce>
      at_owned_nodes() const
      {
        std::vector<NodalForce> result;
        for (const auto &[node, force] : discretization.send_to_owners(forces))
          result.push_back({node, force});
        return result;
      }

    private:
      void
      integrate(FEFaceValues<3>                              &values,
                const Triangulation<3>::active_cell_iterator &cell,
                const unsigned int                            face)
      {
        values.reinit(cell, face);
        std::vector<Tensor<1, 3>> tractions;
        for (const unsigned int q : values.quadrature_point_indices())
          tractions.push_back(
            traction(values.quadrature_point(q), values.normal_vector(q)));
        const auto nodes =
          discretization.cell_nodes(discretization.dof_cell(cell));
        for (unsigned int j = 0; j < nodes.size(); ++j)
          if (scalar.has_support_on_face(j, face))
            {
              Tensor<1, 3> sum;
              for (const unsigned int q : values.quadrature_point_indices())
                sum += values.shape_value(j, q) * values.JxW(q) * tractions[q];
              for (const auto &share : discretization.carriers(nodes[j]))
                forces.emplace_back(share.node, share.weight * sum);
            }
      }

      const Discretization   &discretization;
      const FiniteElement<3> &scalar;
      const Traction         &traction;
      const double            kink;
      const UpdateFlags       flags = update_values | update_quadrature_points |
                                update_normal_vectors | update_JxW_values;
      FEFaceValues<3> whole_face, corners;

      std::vector<std::pair<types::global_dof_index, Tensor<1, 3>>> forces;
    };
  } // namespace


  std::vector<NodalForce>
  face_forces(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const std::string              &place,
              const Traction                 &traction,
              const double                    kink)
  {
    TractionIntegrals integrals(discretization, traction, kink);
    for_each_face(discretization,
                  sets,
                  place,
                  [&](const auto &cell, const unsigned int face) {
                    integrals.add_face(cell, face);
                  });
    return integrals.at_owned_nodes();
  }


  std::vector<NodalForce>
  depth_pressure_forces(const Discretization           &discretization,
                        const std::vector<std::string> &sets,
                        const std::string              &place,
                        const double                    level,
                        const double                    gradient)
  {
    return face_forces(
      discretization,
      sets,
      place,
      [&](const Point<3> &x, const Tensor<1, 3> &normal) {
        return -gradient * std::max(0., level - x[2]) * normal;
      },
      level);
  }


  Tensor<1, 3>
  depth_pressure_resultant(const Discretization           &discretization,
                           const std::vector<std::string> &sets,
                           const std::string              &place,
                           const double                    level,
                           const double                    gradient)
  {
    constexpr unsigned int n_parts = 16; // of an edge
    Tensor<1, 3>           sum;
    for_each_face(
      discretization,
      sets,
      place,
      [&](const auto &cell, const unsigned int number) {
        const auto         face     = cell->face(number);
        const Tensor<1, 3> a        = face->vertex(1) - face->vertex(0),
                           b        = face->vertex(2) - face->vertex(0),
                           ab       = face->vertex(3) - face->vertex(2) - a;
        const Tensor<1, 3> outwards = face->center() - cell->center();
        for (unsigned int part = 0; part < n_parts * n_parts; ++part)
          {
            const double s    = (part % n_parts + 0.5) / n_parts,
                         t    = (part / n_parts + 0.5) / n_parts;
            const Point<3> at = face->vertex(0) + s * a + t * b + s * t * ab;
            const Tensor<1, 3> area =
              cross_product_3d(a + t * ab, b + s * ab) / (n_parts * n_parts);
            sum -= gradient * std::max(0., level - at[2]) *
                   (area * outwards < 0. ? -1. : 1.) * area;
          }
      });
    return Utilities::MPI::sum(sum, discretization.grid.communicator());
  }


  void
  add_to(Vector &vector, const std::vector<NodalForce> &forces)
  {
    for (const auto &[node, force] : forces)
      for (unsigned int d = 0; d < 3; ++d)
        vector.local_element(3 * node + d) += force[d];
  }
} // namespace Voussoir
