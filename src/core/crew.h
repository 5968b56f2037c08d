// Processes that do one pass together.
#pragma once

#include <stdexcept>
#include <vector>

namespace keyhole {

/// A process has died, or can't be reached any more. The command line exits with 1.
class TeamLost : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What one process knows of the others that do the same pass: all go through the same stages and call exchange() at
/// the same places. Each has all results in the end.
class Crew {
  public:
    virtual ~Crew() = default;

    virtual int rank() const = 0;
    virtual int size() const = 0;

    /// The parts of all processes, by rank. `stop`: this one has been asked to stop. @throws TeamLost
    virtual std::vector<std::vector<char>> exchange(std::vector<char> part, bool stop) = 0;
    /// Whether one of them had been asked to stop when exchange() was last called: the same for all, so that all end at
    /// the same place.
    virtual bool stopped() const = 0;
};

} // namespace keyhole
