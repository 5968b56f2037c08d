// A vector with a fixed capacity and no allocation: paths are copied in the innermost loop of a chain.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace keyhole {

/// Copies only the elements in use. Invariant: size() <= N. Elements past size() are unspecified.
template <class T, std::size_t N> class InlineVector {
  public:
    InlineVector() = default;
    InlineVector(const InlineVector& o) { *this = o; }
    InlineVector& operator=(const InlineVector& o) {
        if (this != &o) {
            size_ = o.size_;
            for (std::size_t i = 0; i < size_; ++i) items_[i] = o.items_[i];
        }
        return *this;
    }
    ~InlineVector() = default;

    static constexpr std::size_t capacity() { return N; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == N; }

    T& operator[](std::size_t i) {
        assert(i < size_);
        return items_[i];
    }
    const T& operator[](std::size_t i) const {
        assert(i < size_);
        return items_[i];
    }
    T& back() { return (*this)[size_ - 1]; }
    const T& back() const { return (*this)[size_ - 1]; }
    T* begin() { return items_.data(); }
    T* end() { return items_.data() + size_; }
    const T* begin() const { return items_.data(); }
    const T* end() const { return items_.data() + size_; }

    void push_back(const T& v) {
        assert(!full());
        items_[size_++] = v;
    }
    void pop_back() {
        assert(!empty());
        --size_;
    }
    void clear() { size_ = 0; }
    void resize(std::size_t n) {
        assert(n <= N);
        size_ = n;
    }

  private:
    std::array<T, N> items_;
    std::size_t size_ = 0;
};

} // namespace keyhole
