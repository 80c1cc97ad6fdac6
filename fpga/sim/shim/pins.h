// What all boards with pins have in common.
#pragma once

#include "design.h"

// One step of both clocks: those that `in` names rise. Unlike elsewhere, the outputs are then those after the edge, since that
// is when pins change.
template <class Model, class Inputs>
void clock_edges(Design<Model>& design, const Inputs& in) {
    Model& model = *design.model;
    tie_off(model);
    model.clk = 0;
    model.link_clk = 0;
    model.rst = in.rst;
    model.link_rst = in.rst;
    model.millisecond = in.millisecond;
    design.settle();
    model.clk = in.core_edge;
    model.link_clk = in.link_edge;
    design.settle();
}
