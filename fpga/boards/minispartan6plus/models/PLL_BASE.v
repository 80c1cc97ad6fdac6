// What lint needs of the vendor's cell: its ports.
`default_nettype none

module PLL_BASE #(
    parameter BANDWIDTH = "OPTIMIZED",
    parameter COMPENSATION = "INTERNAL",
    parameter CLKIN_PERIOD = 0.0,             // ns
    parameter DIVCLK_DIVIDE = 1,
    parameter CLKFBOUT_MULT = 1,
    parameter CLKOUT0_DIVIDE = 1
) (
    input  wire RST,
    input  wire CLKIN,
    input  wire CLKFBIN,
    output wire CLKFBOUT,
    output wire LOCKED,
    output wire CLKOUT0
);
    wire unused = &{1'b0, CLKFBIN};

    assign CLKFBOUT = CLKIN;
    assign CLKOUT0 = CLKIN;
    assign LOCKED = !RST;
endmodule

`default_nettype wire
