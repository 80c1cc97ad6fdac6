// The board with its byte ports, in which a number chooses a fault.
#pragma once

#include "bridge.h"

// The fault of every board of this library; 0 is none.
extern "C" uint16_t halfrow_fault;
uint16_t halfrow_fault = 0;

template <class Model>
void clock_faulty(Design<Model>& design, const BridgeInputs& in, BridgeOutputs& out) {
    design.model->fault = halfrow_fault;
    clock_bridge(design, in, out);
}

#undef DESIGN
#define DESIGN(name, Model) OFFER(name, Model, BridgeInputs, BridgeOutputs, clock_faulty)
