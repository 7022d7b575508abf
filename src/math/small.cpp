#include "math/small.h"

namespace aspic {

template Mat3d inverse(const Mat3d& A);

}  // namespace aspic
