#include "collision/contact_clusters.h"

namespace trocar {

Vec3 yield_of_clusters(const ContactConstraint& c, const ContactClusters& clusters) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      const std::int32_t i = c.place[a], j = c.place[b], of = clusters.of[i];
      if (a == b || of < 0 || of != clusters.of[j]) continue;
      sum += c.weight[a] * c.weight[b] *
             clusters.share[i].cwiseProduct(clusters.share[j]).cwiseProduct(clusters.yield[of]);
    }
  return sum;
}

Vec3 move_of_clusters(const ContactConstraint& c, const ContactClusters& clusters) {
  Vec3 move = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a) {
    const std::int32_t i = c.place[a], of = clusters.of[i];
    if (of >= 0)
      move += c.weight[a] *
              clusters.share[i].cwiseProduct(clusters.yield[of]).cwiseProduct(clusters.impulse[of]);
  }
  return move;
}

void add_to_clusters(const ContactConstraint& c, const Vec3& impulse, ContactClusters& clusters) {
  for (std::size_t a = 0; a < 4; ++a) {
    const std::int32_t i = c.place[a], of = clusters.of[i];
    if (of >= 0) clusters.impulse[of] += c.weight[a] * clusters.share[i].cwiseProduct(impulse);
  }
}

}  // namespace trocar
