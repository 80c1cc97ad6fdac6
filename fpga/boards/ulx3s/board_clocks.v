// The clocks of the board. The link runs from the PLL: 25 MHz / 5 = 5 MHz, times 96 in the VCO, divided by 5: 96 MHz, 32 clocks a bit at
// 3 Mbaud. The core runs from the same or, with a sensor, from PIXCLK. The dividers are those of `ecppll -i 25 -o 96 --highres`.
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
    wire feedback;

    (* FREQUENCY_PIN_CLKI = "25", FREQUENCY_PIN_CLKOS = "96", ICP_CURRENT = "12", LPF_RESISTOR = "8" *)
    (* MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
    EHXPLLL #(
        .CLKI_DIV(5), .CLKFB_DIV(2), .FEEDBK_PATH("CLKOP"),
        .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV(48), .CLKOP_CPHASE(9),
        .CLKOS_ENABLE("ENABLED"), .CLKOS_DIV(5), .CLKOS_CPHASE(0)
    ) pll (
        .CLKI(oscillator), .CLKFB(feedback), .CLKOP(feedback), .CLKOS(link_clk), .LOCK(locked), .RST(1'b0), .STDBY(1'b0),
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
