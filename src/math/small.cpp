#include "math/small.h"

namespace aspic {

template Mat3d operator*(const Mat3d& A, const Mat3d& B);
template Mat3d inverse(const Mat3d& A);

}  // namespace aspic
