// Evaluators ask for no memory once they have been used.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "evaluate/rigs.h"
#include "mien/evaluate/evaluator.h"
#include "mien/evaluate/point_evaluator.h"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Every call of the program's own, Eigen's excepted, passes here.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size ? size : 1);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace mien {
namespace {

TEST(NoAllocation, EvaluatorAndPointEvaluatorKeepTheirMemory) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Character character = test::objects_rig(seed);
    if (seed > 3) character.constraints = test::constrained_rig(seed).constraints;
    std::vector<Pose> poses;
    for (unsigned f = 0; f < 10; ++f) poses.push_back(test::objects_pose(character, 10 * seed + f));
    Evaluator evaluator(character);
    PointEvaluator points(character,
                          {{0, -1, 3, {1, 0, 0}, {0, 1, 2}}, {1, 0, -1, {0.2, 0.3, 0.5}, {0, 1, 2}}});
    const Freedoms freedoms{{0, 2}, {}, {{1, true, true}}};
    std::vector<float> rows(3 * evaluator.vertex_count()), blocks(48 * evaluator.block_count());
    PointsD positions;
    Eigen::MatrixXd jacobian;
    const auto use = [&](const Pose& pose) {
      evaluator.evaluate(pose, rows);
      evaluator.evaluate_blocks(pose, blocks);
      evaluator.update_blocks(pose, blocks);
      points.positions(pose, positions);
      points.jacobian(pose, freedoms, jacobian);
    };
    use(poses[0]);
    const std::size_t before = allocations;
    const std::size_t held = mallinfo2().uordblks;
    for (const Pose& pose : poses) use(pose);
    EXPECT_EQ(allocations, before) << "seed " << seed;
    EXPECT_EQ(mallinfo2().uordblks, held) << "seed " << seed;
  }
}

}  // namespace
}  // namespace mien
