#include "softform/linalg/symmetric_indefinite.hpp"

#include <cholmod.h>
#include <dmumps_c.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "softform/core/parallel.hpp"

extern "C" void openblas_set_num_threads(int count);

namespace softform {
namespace {

// MUMPS' jobs and error codes by name (users' guide 5.5, sections 5 and 8).
constexpr int initialize = -1, terminate = -2, analyse = 1, factor = 2, solution = 3;
constexpr int out_of_workspace = -9, out_of_integer_workspace = -8, singular = -10;

// METIS' fill-reducing ordering, through CHOLMOD: Debian's MUMPS is built without METIS. Entry i is the 1-based place
// of unknown i among the pivots, as MUMPS wants it.
std::vector<int> metis_ordering(const SparseMatrix& A)
{
  cholmod_common common{};
  cholmod_start(&common);
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_PATTERN;
  view.sorted = view.packed = 1;
  std::vector<int> order(view.nrow), place(view.nrow);
  const bool is_ordered = cholmod_metis(&view, nullptr, 0, 1, order.data(), &common) != 0;
  cholmod_finish(&common);
  if (!is_ordered) throw std::runtime_error("METIS could not order the matrix (out of memory?)");
  for (std::size_t k = 0; k < order.size(); ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k) + 1;
  return place;
}

}  // namespace

struct SymmetricIndefinite::Mumps {
  DMUMPS_STRUC_C id{};
  SparseMatrix lower;  // the matrix that was factorised: MUMPS refines with it
  std::vector<int> rows, columns, place;
  bool is_factorized = false;

  Mumps()
  {
    id.par = 1;                 // this process works too
    id.sym = 2;                 // symmetric, not definite
    id.comm_fortran = -987654;  // MPI_COMM_WORLD of the sequential stand-in
    run(initialize);
    for (int stream = 1; stream <= 3; ++stream) control(stream) = -1;  // silent
    control(4) = 0;
    control(7) = 1;    // our ordering
    control(10) = 10;  // at most so many refinements
    control(14) = 50;  // [%] workspace above the estimate, for pivots put off
  }
  ~Mumps() { run(terminate); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  int& control(int i) { return id.icntl[i - 1]; }  // numbered as in the users' guide
  int status() const { return id.infog[0]; }
  void run(int job)
  {
    id.job = job;
    dmumps_c(&id);
  }

  bool has_analysed(const SparseMatrix& A) const
  {
    return lower.cols() == A.cols() && lower.nonZeros() == A.nonZeros() &&
           std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1, lower.outerIndexPtr()) &&
           std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), lower.innerIndexPtr());
  }
  void set_pattern();
  void set_values() { id.a = lower.valuePtr(); }
};

void SymmetricIndefinite::Mumps::set_pattern()
{
  rows.clear();
  columns.clear();
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(lower, j); entry; ++entry) {
      rows.push_back(static_cast<int>(entry.row()) + 1);
      columns.push_back(j + 1);
    }
  }
  place = metis_ordering(lower);
  id.n = static_cast<int>(lower.cols());
  id.nnz = lower.nonZeros();
  id.irn = rows.data();
  id.jcn = columns.data();
  id.perm_in = place.data();
  set_values();
  run(analyse);
  if (status() < 0) throw std::runtime_error(fmt::format("MUMPS could not analyse the matrix (error {})", status()));
}

SymmetricIndefinite::SymmetricIndefinite() : mumps_(std::make_unique<Mumps>()) {}
SymmetricIndefinite::~SymmetricIndefinite() = default;
SymmetricIndefinite::SymmetricIndefinite(SymmetricIndefinite&&) noexcept = default;
SymmetricIndefinite& SymmetricIndefinite::operator=(SymmetricIndefinite&&) noexcept = default;

bool SymmetricIndefinite::factorize(const SparseMatrix& A)
{
  Mumps& mumps = *mumps_;
  mumps.is_factorized = false;
  const SparseMatrix lower = A.triangularView<Eigen::Lower>();
  if (!lower.coeffs().allFinite()) return false;
  const bool is_known = mumps.has_analysed(lower);
  mumps.lower = lower;
  if (is_known)
    mumps.set_values();
  else
    mumps.set_pattern();
  // As in SparseFactorization: BLAS' threads only where the fronts are large enough to gain from them.
  openblas_set_num_threads(mumps.id.rinfog[0] > 5e9 ? thread_count() : 1);
  mumps.run(factor);
  while (mumps.status() == out_of_workspace || mumps.status() == out_of_integer_workspace) {
    mumps.control(14) *= 2;
    mumps.run(factor);
  }
  if (mumps.status() < 0 && mumps.status() != singular)
    throw std::runtime_error(fmt::format("MUMPS could not factorise the matrix (error {})", mumps.status()));
  mumps.is_factorized = mumps.status() >= 0;
  return mumps.is_factorized;
}

int SymmetricIndefinite::negative_eigenvalues() const { return mumps_->id.infog[11]; }

Vec SymmetricIndefinite::solve(ConstVec b) const
{
  Mumps& mumps = *mumps_;
  if (!mumps.is_factorized) throw std::runtime_error("MUMPS has no factorisation to solve with");
  Vec x = b;
  mumps.id.rhs = x.data();
  mumps.run(solution);
  if (mumps.status() < 0) throw std::runtime_error(fmt::format("MUMPS could not solve (error {})", mumps.status()));
  return x;
}

double SymmetricIndefinite::factor_nonzeros() const
{
  const double count = mumps_->id.infog[8];
  return count < 0 ? -1e6 * count : count;  // MUMPS gives large numbers in millions, negative
}

}  // namespace softform
