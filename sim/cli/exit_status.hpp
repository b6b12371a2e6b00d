// The exit statuses of the verbs. Those that run the flight program also have 128 and the number of the
// signal that ended them.
#pragma once

namespace tumblesight::sim {

inline constexpr int kFailed = 1;        // a file, a run or the output
inline constexpr int kBadArguments = 2;  // nothing was begun
inline constexpr int kStopped = 3;       // a training or a campaign, which the same command continues
// The work is done, and its result is of no use as it is: most attitudes are wrong, the image in fixed point
// is not the network in float32, or no network can use the mesh.
inline constexpr int kOfNoUse = 4;

}  // namespace tumblesight::sim
