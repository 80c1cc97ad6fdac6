// The clocks of the board. The link runs from the PLL: 32 MHz * 30 / 10 = 96 MHz, eight clocks a bit at 12 Mbaud. (96 MHz cannot
// be made of the 50 MHz oscillator by a Spartan-6 PLL.) The core runs from the same or, with a sensor, from PIXCLK.
`default_nettype none

module board_clocks #(
    parameter SENSOR = 0                       // 1: with a sensor
) (
    input  wire oscillator,                    // pin, 32 MHz
    input  wire pixclk,                        // pin; not looked at without a sensor
    input  wire choose_pixclk,
    output wire link_clk,
    output wire locked,
    output wire pixclk_direct,                 // PIXCLK whatever was chosen
    output wire clk
);
    wire from_oscillator, feedback, from_pll;

    IBUFG oscillator_buffer (.I(oscillator), .O(from_oscillator));

    PLL_BASE #(
        .BANDWIDTH("OPTIMIZED"), .COMPENSATION("INTERNAL"), .CLKIN_PERIOD(31.25),
        .DIVCLK_DIVIDE(1), .CLKFBOUT_MULT(30), .CLKOUT0_DIVIDE(10)
    ) pll (
        .RST(1'b0), .CLKIN(from_oscillator), .CLKFBIN(feedback), .CLKFBOUT(feedback), .LOCKED(locked),
        .CLKOUT0(from_pll));

    BUFG link_buffer (.I(from_pll), .O(link_clk));

    generate
        if (SENSOR != 0) begin : with_sensor
            wire from_sensor;

            IBUFG sensor_buffer (.I(pixclk), .O(from_sensor));
            BUFG direct_buffer (.I(from_sensor), .O(pixclk_direct));

            // ASYNC, since the default kind waits for an edge of a clock that may have stopped. A short pulse that this can
            // let through when it turns to a running PIXCLK finds the core in reset, and its memories are filled again behind it.
            BUFGMUX #(.CLK_SEL_TYPE("ASYNC")) core_buffer (
                .I0(from_pll), .I1(from_sensor), .S(choose_pixclk), .O(clk));
        end else begin : without_sensor
            wire unused = &{1'b0, pixclk, choose_pixclk};

            assign pixclk_direct = 1'b0;
            assign clk = link_clk;
        end
    endgenerate
endmodule

`default_nettype wire
