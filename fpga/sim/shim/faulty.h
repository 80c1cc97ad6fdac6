// The board with its byte ports, with faults of which a number chooses one.
#pragma once

#include "bridge.h"

// The fault of the next board of this library, which reads it at power-up; 0 for none.
extern "C" uint16_t halfrow_fault;
uint16_t halfrow_fault = 0;
