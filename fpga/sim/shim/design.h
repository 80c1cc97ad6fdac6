// A verilated design with its clock, its context and its waveform.
#pragma once

#include <cerrno>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "verilated.h"
#include "verilated_vcd_c.h"

// A waveform's file. What cannot be written is passed over and noted: the library would try to end the program, and hang in its
// own locks.
struct WaveformFile : VerilatedVcdFile {
    bool is_whole = true;

    ssize_t write(const char* bytes, ssize_t length) override {
        if (!is_whole) return length;
        const ssize_t written = VerilatedVcdFile::write(bytes, length);
        if (written >= 0 || errno == EAGAIN || errno == EINTR) return written;
        is_whole = false;
        return length;
    }
};

// Whether a model was translated with what a waveform needs.
template <class Model, class = void>
struct IsTraced : std::false_type {};
template <class Model>
struct IsTraced<Model, std::void_t<decltype(std::declval<Model&>().trace(std::declval<VerilatedVcdC*>(), 99))>>
    : std::true_type {};

template <class Model>
struct Design {
    VerilatedContext context;
    std::unique_ptr<Model> model;
    WaveformFile waveform;
    std::unique_ptr<VerilatedVcdC> trace;

    // Registers and memories power up with what `seed` draws.
    explicit Design(uint32_t seed) {
        context.randReset(2);
        context.randSeed(static_cast<int>(seed & 0x7fffffff));
        context.traceEverOn(IsTraced<Model>::value);
        model = std::make_unique<Model>(&context, "");
    }

    ~Design() {
        if (trace) trace->close();
        model->final();
    }

    bool trace_to(const char* path) {
        if constexpr (IsTraced<Model>::value) {
            trace = std::make_unique<VerilatedVcdC>(&waveform);
            model->trace(trace.get(), 99);
            trace->open(path);
            return trace->isOpen();
        }
        return false;
    }

    // Whether all of the waveform until now is in its file; true if there is none.
    bool is_traced() {
        if (trace) trace->flush();
        return waveform.is_whole;
    }

    // Settles everything that depends on the inputs. With all clocks low, the outputs are then what a register samples at the
    // next edge.
    void settle() {
        model->eval();
        if (VL_UNLIKELY(trace)) trace->dump(context.time());
        context.timeInc(1);
    }
};

// Ties off the inputs of a board without a clock to report, a serial number or a camera.
template <class Model>
void tie_off(Model& model) {
    model.clock_source = 0;
    model.clock_hz = 0;
    model.serial = 0;
    model.camera_frame_valid = 0;
    model.camera_line_valid = 0;
    model.camera_data = 0;
}

// The functions of a design that Rust calls.
template <class Inputs, class Outputs>
struct Functions {
    void* (*create)(uint32_t seed);
    void (*destroy)(void* design);
    bool (*trace)(void* design, const char* path);
    bool (*is_traced)(void* design);
    void (*clock)(void* design, const Inputs* inputs, Outputs* outputs);
};

template <class Model, class Inputs, class Outputs, void (*clock)(Design<Model>&, const Inputs&, Outputs&)>
constexpr Functions<Inputs, Outputs> functions() {
    return {
        [](uint32_t seed) -> void* { return new Design<Model>(seed); },
        [](void* design) { delete static_cast<Design<Model>*>(design); },
        [](void* design, const char* path) { return static_cast<Design<Model>*>(design)->trace_to(path); },
        [](void* design) { return static_cast<Design<Model>*>(design)->is_traced(); },
        [](void* design, const Inputs* inputs, Outputs* outputs) {
            clock(*static_cast<Design<Model>*>(design), *inputs, *outputs);
        },
    };
}

#define OFFER(name, Model, Inputs, Outputs, clock) \
    extern "C" const Functions<Inputs, Outputs> halfrow_##name; \
    const Functions<Inputs, Outputs> halfrow_##name = functions<Model, Inputs, Outputs, clock<Model>>();
