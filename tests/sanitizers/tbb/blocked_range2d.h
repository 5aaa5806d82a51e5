#pragma once

namespace tbb {

template <class Index>
class blocked_range2d {
public:
    struct Side {
        Index first, last;
        [[nodiscard]] Index begin() const { return first; }
        [[nodiscard]] Index end() const { return last; }
    };
    /// Tiles of two, whatever the grain: small pictures too are to be shared out.
    blocked_range2d(Index top, Index bottom, Index, Index left, Index right, Index)
        : rows_{top, bottom}, cols_{left, right} {}
    [[nodiscard]] const Side& rows() const { return rows_; }
    [[nodiscard]] const Side& cols() const { return cols_; }
    static constexpr Index tile = 2;

private:
    Side rows_, cols_;
};

}  // namespace tbb
