// SPDX-License-Identifier: MIT
// The priority of a thread, for work that gives way to drawing.
#pragma once

namespace alpenglow::atmosphere {

/// Lowers the priority of the calling thread, and of the threads that it will start, by steps of
/// `nice`: a thread that is ten steps lower gets a tenth of the time of a core for which both
/// compete, and all of it otherwise. A thread cannot raise its priority again. Systems other than
/// Linux have no such priority for a single thread: there the function does nothing.
/// @param steps  at least 0. The lowest priority of the system is the limit.
void LowerPriorityOfThread(int steps);

}  // namespace alpenglow::atmosphere
