// Models of the ECP5 cells that nextpnr leaves of a design behind routing, for routed.py's Verilog: slices cut into their LUTs (with
// carry and distributed RAM), registers and write ports. TO_Q: picoseconds from the clock to a register's output.
`default_nettype none
`timescale 1ps / 1ps

module TRELLIS_COMB #(
    parameter MODE = "LOGIC",
    parameter [15:0] INITVAL = 16'd0,
    parameter CCU2_INJECT1 = "NO",
    parameter TO_Q = 0
) (
    input  wire A,
    input  wire B,
    input  wire C,
    input  wire D,
    input  wire M,
    input  wire F1,
    input  wire FXA,
    input  wire FXB,
    input  wire FCI,
    input  wire WD,
    input  wire WAD0,
    input  wire WAD1,
    input  wire WAD2,
    input  wire WAD3,
    input  wire WRE,
    input  wire WCK,
    input  wire UPPER,                 // OFX is of FXA and FXB, otherwise of this LUT and F1
    output wire F,
    output wire FCO,
    output wire OFX
);
    generate
        if (MODE == "CCU2") begin : carry
            wire whole = INITVAL[{D, C, B, A}];
            wire half = INITVAL[{2'b00, B, A}];
            wire passed = CCU2_INJECT1 == "YES" ? 1'b0 : FCI;
            wire made = CCU2_INJECT1 == "YES" ? 1'b0 : half;
            assign F = whole ^ passed;
            assign FCO = whole ? FCI : made;
        end else if (MODE == "DPRAM") begin : memory
            reg [15:0] bits = INITVAL;
            always @(posedge WCK)
                if (WRE) bits[{WAD3, WAD2, WAD1, WAD0}] <= #TO_Q WD;
            assign F = bits[{A, C, B, D}];
            assign FCO = 1'b0;
        end else begin : table_alone
            assign F = INITVAL[{D, C, B, A}];
            assign FCO = 1'b0;
        end
    endgenerate

    assign OFX = UPPER ? (M ? FXB : FXA) : (M ? F1 : F);
endmodule

module TRELLIS_FF #(
    parameter SD = "1",
    parameter REGSET = "RESET",
    parameter SRMODE = "LSR_OVER_CE",
    parameter TO_Q = 0
) (
    input  wire CLK,
    input  wire LSR,
    input  wire CE,
    input  wire DI,
    input  wire M,
    output reg  Q
);
    localparam SET = REGSET == "SET";
    wire next = SD == "0" ? M : DI;

    initial Q = SET;

    generate
        if (SRMODE == "ASYNC") begin : at_once
            always @(posedge CLK or posedge LSR)
                if (LSR) Q <= #TO_Q SET;
                else if (CE) Q <= #TO_Q next;
        end else begin : in_step
            always @(posedge CLK)
                if (LSR) Q <= #TO_Q SET;
                else if (CE) Q <= #TO_Q next;
        end
    endgenerate
endmodule

module TRELLIS_RAMW (
    input  wire A0,
    input  wire B0,
    input  wire C0,
    input  wire D0,
    input  wire A1,
    input  wire B1,
    input  wire C1,
    input  wire D1,
    output wire WADO0,
    output wire WADO1,
    output wire WADO2,
    output wire WADO3,
    output wire WDO0,
    output wire WDO1,
    output wire WDO2,
    output wire WDO3
);
    assign {WADO3, WADO2, WADO1, WADO0} = {A0, C0, B0, D0};
    assign {WDO3, WDO2, WDO1, WDO0} = {B1, D1, A1, C1};
endmodule

module DCCA (
    input  wire CLKI,
    output wire CLKO
);
    assign CLKO = CLKI;
endmodule

`default_nettype wire
