// What a rank computes of a body: the whole one, or some of its elements as one of their own.
#pragma once

#include "mesh/partition.h"
#include "solver/model.h"
#include "solver/neighbours.h"

namespace trocar {

struct RankBody {
  Part part;
  Halo halo;
  Neighbours neighbours;  // keeps a pointer to the halo
  Model model;
  State state;
  Scratch scratch;
};

}  // namespace trocar
