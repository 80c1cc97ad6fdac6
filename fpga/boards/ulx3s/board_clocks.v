// The clocks of the board. The link runs at 96 MHz, 32 clocks a bit at 3 Mbaud, from two PLLs: the first makes 24 MHz of the oscillator's
// 25 MHz, the second 96 MHz of those. One alone would have to compare phases at 5 MHz, and below 10 MHz its lock is not guaranteed
// (plls.py has the limits). The core runs from the same or, with a sensor, from PIXCLK. All settings are those of
// `ecppll -i 25 --clkout0 25 --clkout1 24` and `ecppll -i 24 --clkout0 96 --reset`.
`default_nettype none

module board_clocks #(
    parameter SENSOR = 0                       // 1: with a sensor
) (
    input  wire oscillator,                    // pin, 25 MHz
    input  wire pixclk,                        // pin; not looked at without a sensor
    input  wire choose_pixclk,
    output wire link_clk,
    output wire locked,
    output wire pixclk_direct,                 // PIXCLK whatever was chosen
    output wire clk
);
    wire feedback, between, first_locked, unused_clock;

    // 25 MHz, times 24 in the VCO: 600 MHz, divided by 25.
    (* FREQUENCY_PIN_CLKI = "25", FREQUENCY_PIN_CLKOP = "25", FREQUENCY_PIN_CLKOS = "24", ICP_CURRENT = "12", LPF_RESISTOR = "8" *)
    (* MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
    EHXPLLL #(
        .CLKI_DIV(1), .CLKFB_DIV(1), .FEEDBK_PATH("CLKOP"),
        .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV(24), .CLKOP_CPHASE(11),
        .CLKOS_ENABLE("ENABLED"), .CLKOS_DIV(25), .CLKOS_CPHASE(11)
    ) first_pll (
        .CLKI(oscillator), .CLKFB(feedback), .CLKOP(feedback), .CLKOS(between), .LOCK(first_locked), .RST(1'b0), .STDBY(1'b0),
        .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1), .PHASESTEP(1'b1), .PHASELOADREG(1'b1), .PLLWAKESYNC(1'b0),
        .ENCLKOP(1'b0));

    // 24 MHz, times 24 in the VCO: 576 MHz, divided by 6. Its reset makes `locked` say that both are.
    (* FREQUENCY_PIN_CLKI = "24", FREQUENCY_PIN_CLKOP = "96", ICP_CURRENT = "12", LPF_RESISTOR = "8" *)
    (* MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
    EHXPLLL #(
        .PLLRST_ENA("ENABLED"), .CLKI_DIV(1), .CLKFB_DIV(4), .FEEDBK_PATH("CLKOP"),
        .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV(6), .CLKOP_CPHASE(2)
    ) second_pll (
        .CLKI(between), .CLKFB(link_clk), .CLKOP(link_clk), .CLKOS(unused_clock), .LOCK(locked), .RST(!first_locked), .STDBY(1'b0),
        .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1), .PHASESTEP(1'b1), .PHASELOADREG(1'b1), .PLLWAKESYNC(1'b0),
        .ENCLKOP(1'b0));

    generate
        if (SENSOR != 0) begin : with_sensor
            assign pixclk_direct = pixclk;

            // Logic and not the vendor's DCSC, which waits for an edge of a clock that may have stopped. A short pulse that this can let
            // through when it turns to a running PIXCLK finds the core in reset, and its memories are filled again behind it.
            wire chosen = choose_pixclk ? pixclk : link_clk;
            (* keep *) wire core_clock;        // named in sensor.lpf

            DCCA core_buffer (.CLKI(chosen), .CE(1'b1), .CLKO(core_clock));
            assign clk = core_clock;
        end else begin : without_sensor
            wire unused = &{1'b0, pixclk, choose_pixclk};

            assign pixclk_direct = 1'b0;
            assign clk = link_clk;
        end
    endgenerate
endmodule

`default_nettype wire
