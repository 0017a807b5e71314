#include "softform/linalg/sparse_factorization.hpp"

#include <cholmod.h>
#include <omp.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "softform/core/parallel.hpp"

extern "C" void openblas_set_num_threads(int count);

namespace softform {
namespace {

// CHOLMOD opens parallel regions of four threads whatever the machine has, and OpenBLAS adds its own: on two cores they
// spin against each other, and factorising the bunny's tangent took 62 ms instead of 21 ms. So CHOLMOD's regions are
// made serial, and BLAS gets every core only where the supernodes are large enough to gain from it: with 8e9 flops (a
// rest-shape step on 3265 vertices) two threads of one core took no less time than one and twice the work, waiting.
class SerialRegions {
 public:
  explicit SerialRegions(double flops) : levels_(omp_get_max_active_levels())
  {
    constexpr double worth_threads = 5e10;
    openblas_set_num_threads(flops > worth_threads ? thread_count() : 1);
    omp_set_max_active_levels(0);
  }
  ~SerialRegions() { omp_set_max_active_levels(levels_); }
  SerialRegions(const SerialRegions&) = delete;
  SerialRegions& operator=(const SerialRegions&) = delete;

 private:
  int levels_;
};

}  // namespace

// One cholmod workspace and the two kinds of factor, each with a symbolic analysis of its own.
struct SparseFactorization::Cholmod {
  cholmod_common common{};
  cholmod_factor* supernodal = nullptr;
  cholmod_factor* simplicial = nullptr;
  cholmod_factor* current = nullptr;
  std::vector<int> column_starts, rows;  // the pattern that was analysed

  Cholmod()
  {
    cholmod_start(&common);
    // One ordering only: the default tries several, which costs more than it gains on surface meshes.
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.print = 0;
    common.error_handler = nullptr;
    common.quick_return_if_not_posdef = 1;
  }
  ~Cholmod()
  {
    forget();
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void forget()
  {
    cholmod_free_factor(&supernodal, &common);
    cholmod_free_factor(&simplicial, &common);
    current = nullptr;
  }

  // Every index is compared: one pass, cheap beside the factorisation.
  bool has_analysed(const SparseMatrix& A) const
  {
    return std::equal(column_starts.begin(), column_starts.end(), A.outerIndexPtr(),
                      A.outerIndexPtr() + A.cols() + 1) &&
           std::equal(rows.begin(), rows.end(), A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
  }

  bool factorize(const SparseMatrix& A, int kind, cholmod_factor*& factor);
};

namespace {

cholmod_sparse view(const SparseMatrix& A)
{
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(A.rows());
  view.ncol = static_cast<std::size_t>(A.cols());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

int count_negative_pivots(const cholmod_factor& factor)
{
  const auto* start = static_cast<const int*>(factor.p);
  const auto* values = static_cast<const double*>(factor.x);
  int count = 0;
  for (std::size_t j = 0; j < factor.n; ++j) count += values[start[j]] < 0;
  return count;
}

}  // namespace

bool SparseFactorization::Cholmod::factorize(const SparseMatrix& A, int kind, cholmod_factor*& factor)
{
  if (!has_analysed(A)) {
    forget();
    column_starts.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1);
    rows.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
  }
  cholmod_sparse matrix = view(A);
  common.supernodal = kind;
  common.final_ll = 0;
  if (factor == nullptr) factor = cholmod_analyze(&matrix, &common);
  if (factor == nullptr) throw std::runtime_error("CHOLMOD could not analyse the matrix (out of memory?)");
  const SerialRegions serial(common.fl);
  cholmod_factorize(&matrix, factor, &common);
  current = factor;
  return common.status == CHOLMOD_OK && factor->minor == factor->n;
}

SparseFactorization::SparseFactorization() : cholmod_(std::make_unique<Cholmod>()) {}
SparseFactorization::~SparseFactorization() = default;
SparseFactorization::SparseFactorization(SparseFactorization&&) noexcept = default;
SparseFactorization& SparseFactorization::operator=(SparseFactorization&&) noexcept = default;

bool SparseFactorization::cholesky(const SparseMatrix& A)
{
  ++attempts_;
  negative_eigenvalues_ = 0;
  return cholmod_->factorize(A, CHOLMOD_SUPERNODAL, cholmod_->supernodal);
}

bool SparseFactorization::indefinite(const SparseMatrix& A)
{
  ++attempts_;
  const bool factorized = cholmod_->factorize(A, CHOLMOD_SIMPLICIAL, cholmod_->simplicial);
  negative_eigenvalues_ = factorized ? count_negative_pivots(*cholmod_->simplicial) : -1;
  return factorized;
}

Vec SparseFactorization::solve(ConstVec b) const
{
  cholmod_dense rhs{};
  rhs.nrow = rhs.d = rhs.nzmax = static_cast<std::size_t>(b.size());
  rhs.ncol = 1;
  rhs.x = const_cast<double*>(b.data());
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  const SerialRegions serial(0);
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, cholmod_->current, &rhs, &cholmod_->common);
  if (solution == nullptr) throw std::runtime_error("CHOLMOD could not solve (no factorisation, or out of memory)");
  Vec x = Eigen::Map<const Vec>(static_cast<const double*>(solution->x), b.size());
  cholmod_free_dense(&solution, &cholmod_->common);
  return x;
}

double SparseFactorization::factor_nonzeros() const { return cholmod_->common.lnz; }

}  // namespace softform
