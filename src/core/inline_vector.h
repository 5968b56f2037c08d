// A vector with a fixed capacity and no allocation: paths are copied in the innermost loop of a chain.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace keyhole {

/// Makes and copies only the elements in use: capacity costs nothing. Invariant: size() <= N.
template <class T, std::size_t N> class InlineVector {
    static_assert(std::is_trivially_destructible_v<T>);

  public:
    InlineVector() {} // NOLINT(modernize-use-equals-default): that would clear the storage
    InlineVector(const InlineVector& o) : size_(o.size_) { std::uninitialized_copy_n(o.items_, size_, items_); }
    InlineVector& operator=(const InlineVector& o) {
        if (this != &o) {
            size_ = o.size_;
            std::uninitialized_copy_n(o.items_, size_, items_);
        }
        return *this;
    }
    ~InlineVector() = default;

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == N; }

    T& operator[](std::integral auto i) {
        assert(static_cast<std::size_t>(i) < size_);
        return items_[i];
    }
    const T& operator[](std::integral auto i) const {
        assert(static_cast<std::size_t>(i) < size_);
        return items_[i];
    }
    T& back() { return (*this)[size_ - 1]; }
    const T& back() const { return (*this)[size_ - 1]; }
    T* begin() { return items_; }
    T* end() { return items_ + size_; }
    const T* begin() const { return items_; }
    const T* end() const { return items_ + size_; }

    void push_back(const T& v) {
        assert(!full());
        std::construct_at(items_ + size_++, v);
    }
    /// Appends an element as its default constructor leaves it; T{} might clear it before.
    T& emplace_back() {
        assert(!full());
        return *::new (static_cast<void*>(items_ + size_++)) T;
    }
    void pop_back() {
        assert(!empty());
        --size_;
    }
    void clear() { size_ = 0; }

  private:
    std::size_t size_ = 0;
    union {
        T items_[N]; // alive below size_
    };
};

} // namespace keyhole
