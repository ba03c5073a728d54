// Every vertex has the set of shapes and joints that move it. Sorted by the rank of that set in a Gray code, neighbours
// differ in one bit wherever both sets occur: a block of 16 vertices then lists hardly more than one vertex does. Which
// bit leads decides how many blocks straddle a change; the most and the least frequent bit first are both tried.
#include "mien/evaluate/detail/gray_order.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <string_view>
#include <unordered_map>

namespace mien::detail {
namespace {

using Row = std::span<const std::uint64_t>;

/// The distinct sets, and which of them each row has.
struct Distinct {
  std::vector<int> example;  // a row with the set
  std::vector<int> of_row;
};

Distinct distinct_sets(const BitSets& sets, std::size_t rows) {
  Distinct distinct;
  std::unordered_map<std::string_view, int> known;
  for (std::size_t r = 0; r < rows; ++r) {
    const std::string_view bytes(reinterpret_cast<const char*>(sets.bits.data() + r * sets.words),
                                 sets.words * 8);
    const auto [found, is_new] = known.try_emplace(bytes, static_cast<int>(distinct.example.size()));
    if (is_new) distinct.example.push_back(static_cast<int>(r));
    distinct.of_row.push_back(found->second);
  }
  return distinct;
}

std::vector<int> bit_counts(const BitSets& sets, std::size_t bit_count) {
  std::vector<int> counts(bit_count, 0);
  for (std::size_t r = 0; r < sets.count(); ++r)
    for (std::size_t w = 0; w < sets.words; ++w)
      for (std::uint64_t left = sets.bits[r * sets.words + w]; left; left &= left - 1)
        ++counts[64 * w + static_cast<std::size_t>(std::countr_zero(left))];
  return counts;
}

/// Rank of a set in the Gray code whose leading bits are `order`: bit k of the rank is the parity of the first k + 1.
std::vector<std::uint64_t> gray_rank(Row set, const std::vector<int>& order) {
  std::vector<std::uint64_t> rank(set.size(), 0);
  std::uint64_t parity = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto bit = static_cast<std::size_t>(order[k]);
    parity ^= set[bit / 64] >> (bit % 64) & 1;
    rank[k / 64] |= parity << (63 - k % 64);
  }
  return rank;
}

std::vector<int> sorted_rows(const BitSets& sets, const Distinct& distinct, const std::vector<int>& order) {
  std::vector<std::vector<std::uint64_t>> ranks;
  for (const int row : distinct.example)
    ranks.push_back(
        gray_rank({sets.bits.data() + static_cast<std::size_t>(row) * sets.words, sets.words}, order));
  std::vector<int> by_rank(ranks.size());
  std::iota(by_rank.begin(), by_rank.end(), 0);
  std::sort(by_rank.begin(), by_rank.end(), [&](int a, int b) { return ranks[a] < ranks[b]; });
  std::vector<int> place(by_rank.size());
  for (std::size_t k = 0; k < by_rank.size(); ++k) place[by_rank[k]] = static_cast<int>(k);
  std::vector<int> rows(distinct.of_row.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::stable_sort(rows.begin(), rows.end(),
                   [&](int a, int b) { return place[distinct.of_row[a]] < place[distinct.of_row[b]]; });
  return rows;
}

/// Bits in the unions of all runs.
std::size_t union_size(const BitSets& sets, const std::vector<int>& rows, std::size_t run) {
  std::size_t total = 0;
  std::vector<std::uint64_t> all(sets.words);
  for (std::size_t begin = 0; begin < rows.size(); begin += run) {
    std::fill(all.begin(), all.end(), 0);
    for (std::size_t r = begin; r < std::min(begin + run, rows.size()); ++r)
      for (std::size_t w = 0; w < sets.words; ++w)
        all[w] |= sets.bits[static_cast<std::size_t>(rows[r]) * sets.words + w];
    for (const std::uint64_t word : all) total += static_cast<std::size_t>(std::popcount(word));
  }
  return total;
}

}  // namespace

std::vector<int> gray_order(const BitSets& sets, std::size_t bit_count, std::size_t run) {
  const Distinct distinct = distinct_sets(sets, sets.count());
  const std::vector<int> counts = bit_counts(sets, bit_count);
  std::vector<int> order(bit_count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> best = sorted_rows(sets, distinct, order);
  std::size_t best_size = union_size(sets, best, run);
  for (const bool most_first : {true, false}) {
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return most_first ? counts[a] > counts[b] : counts[a] < counts[b];
    });
    std::vector<int> rows = sorted_rows(sets, distinct, order);
    if (const std::size_t size = union_size(sets, rows, run); size < best_size) {
      best_size = size;
      best = std::move(rows);
    }
  }
  return best;
}

}  // namespace mien::detail
