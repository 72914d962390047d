#pragma once

namespace strongpoint {

/// What the machine does just now with two well-known pieces of work on one thread, so that times
/// measured beside them can be compared with those of another machine.
struct Calibration {
  double copy_gigabytes_per_second;  ///< read and written, arrays far larger than the caches
  double factor_seconds;  ///< CPU seconds of an LU of the five-point Laplacian on 100 x 100 points
                          ///< by UMFPACK with its own defaults
};

/// Measures both, the best of three runs each; takes about a quarter of a second.
Calibration calibrate();

}  // namespace strongpoint
