// Models of the Spartan-6 block RAMs in the forms that yosys makes of an inferred memory: both ports of one width, no output
// register, no reset. Other forms end the simulation. Where a port reads and writes at once it gets the old word, or the new one in the
// form WRITE_FIRST, in which the other port then gets no word that anybody knows: here the old one inverted.
`default_nettype none

module block_ram #(
    parameter BITS = 14,                     // of an address that counts bits
    parameter WIDTH_A = 0,
    parameter WIDTH_B = 0,
    parameter NEW_A = 0,                     // WRITE_FIRST
    parameter NEW_B = 0
) (
    input  wire            clk_a,
    input  wire            clk_b,
    input  wire            enable_a,
    input  wire            enable_b,
    input  wire [3:0]      write_a,          // a byte each, with its parity bit
    input  wire [3:0]      write_b,
    input  wire [BITS-1:0] address_a,
    input  wire [BITS-1:0] address_b,
    input  wire [35:0]     in_a,             // {parity, data}
    input  wire [35:0]     in_b,
    output reg  [35:0]     out_a,
    output reg  [35:0]     out_b
);
    localparam WIDTH = (WIDTH_A > WIDTH_B) ? WIDTH_A : WIDTH_B;
    localparam SHIFT = (WIDTH == 36) ? 5 : (WIDTH == 18) ? 4 : (WIDTH == 9) ? 3 : (WIDTH == 4) ? 2 : (WIDTH == 2) ? 1 : 0;

    integer    lane_a, lane_b;
    reg [35:0] words [0:(1 << (BITS - SHIFT))-1];
    wire       same = address_a[BITS-1:SHIFT] == address_b[BITS-1:SHIFT];

    always @(posedge clk_a)
        if (enable_a) begin
            out_a <= words[address_a[BITS-1:SHIFT]] ^ {36{same && NEW_B != 0 && enable_b && write_b != 4'd0}};
            for (lane_a = 0; lane_a < 4; lane_a = lane_a + 1)
                if (write_a[lane_a]) begin
                    words[address_a[BITS-1:SHIFT]][8*lane_a +: 8] <= in_a[8*lane_a +: 8];
                    words[address_a[BITS-1:SHIFT]][32 + lane_a] <= in_a[32 + lane_a];
                    if (NEW_A != 0) begin
                        out_a[8*lane_a +: 8] <= in_a[8*lane_a +: 8];
                        out_a[32 + lane_a] <= in_a[32 + lane_a];
                    end
                end
        end

    always @(posedge clk_b)
        if (enable_b) begin
            out_b <= words[address_b[BITS-1:SHIFT]] ^ {36{same && NEW_A != 0 && enable_a && write_a != 4'd0}};
            for (lane_b = 0; lane_b < 4; lane_b = lane_b + 1)
                if (write_b[lane_b]) begin
                    words[address_b[BITS-1:SHIFT]][8*lane_b +: 8] <= in_b[8*lane_b +: 8];
                    words[address_b[BITS-1:SHIFT]][32 + lane_b] <= in_b[32 + lane_b];
                    if (NEW_B != 0) begin
                        out_b[8*lane_b +: 8] <= in_b[8*lane_b +: 8];
                        out_b[32 + lane_b] <= in_b[32 + lane_b];
                    end
                end
        end

    initial
        if (WIDTH_A != 0 && WIDTH_B != 0 && WIDTH_A != WIDTH_B) begin
            $display("block_ram: ports of %0d and %0d bits", WIDTH_A, WIDTH_B);
            $stop;
        end
endmodule

module RAMB16BWER (
    input  wire        CLKA,
    input  wire        CLKB,
    input  wire        ENA,
    input  wire        ENB,
    input  wire        REGCEA,
    input  wire        REGCEB,
    input  wire        RSTA,
    input  wire        RSTB,
    input  wire [3:0]  WEA,
    input  wire [3:0]  WEB,
    input  wire [13:0] ADDRA,
    input  wire [13:0] ADDRB,
    input  wire [31:0] DIA,
    input  wire [31:0] DIB,
    input  wire [3:0]  DIPA,
    input  wire [3:0]  DIPB,
    output wire [31:0] DOA,
    output wire [31:0] DOB,
    output wire [3:0]  DOPA,
    output wire [3:0]  DOPB
);
    parameter DATA_WIDTH_A = 0;
    parameter DATA_WIDTH_B = 0;
    parameter DOA_REG = 0;
    parameter DOB_REG = 0;
    parameter WRITE_MODE_A = "";
    parameter WRITE_MODE_B = "";
    localparam NEW_A = WRITE_MODE_A == "WRITE_FIRST";
    localparam NEW_B = WRITE_MODE_B == "WRITE_FIRST";

    block_ram #(.BITS(14), .WIDTH_A(DATA_WIDTH_A), .WIDTH_B(DATA_WIDTH_B), .NEW_A(NEW_A), .NEW_B(NEW_B)) ram (
        .clk_a(CLKA), .clk_b(CLKB), .enable_a(ENA), .enable_b(ENB), .write_a(WEA), .write_b(WEB),
        .address_a(ADDRA), .address_b(ADDRB), .in_a({DIPA, DIA}), .in_b({DIPB, DIB}),
        .out_a({DOPA, DOA}), .out_b({DOPB, DOB}));

    initial
        if (DOA_REG != 0 || DOB_REG != 0 || !(NEW_A || WRITE_MODE_A == "READ_FIRST") || !(NEW_B || WRITE_MODE_B == "READ_FIRST")) begin
            $display("RAMB16BWER: a form without a model");
            $stop;
        end
endmodule

module RAMB8BWER (
    input  wire        CLKAWRCLK,
    input  wire        CLKBRDCLK,
    input  wire        ENAWREN,
    input  wire        ENBRDEN,
    input  wire        REGCEA,
    input  wire        REGCEBREGCE,
    input  wire        RSTA,
    input  wire        RSTBRST,
    input  wire [1:0]  WEAWEL,
    input  wire [1:0]  WEBWEU,
    input  wire [12:0] ADDRAWRADDR,
    input  wire [12:0] ADDRBRDADDR,
    input  wire [15:0] DIADI,
    input  wire [15:0] DIBDI,
    input  wire [1:0]  DIPADIP,
    input  wire [1:0]  DIPBDIP,
    output wire [15:0] DOADO,
    output wire [15:0] DOBDO,
    output wire [1:0]  DOPADOP,
    output wire [1:0]  DOPBDOP
);
    parameter DATA_WIDTH_A = 0;
    parameter DATA_WIDTH_B = 0;
    parameter DOA_REG = 0;
    parameter DOB_REG = 0;
    parameter RAM_MODE = "";
    parameter WRITE_MODE_A = "";
    parameter WRITE_MODE_B = "";
    localparam NEW_A = WRITE_MODE_A == "WRITE_FIRST";
    localparam NEW_B = WRITE_MODE_B == "WRITE_FIRST";

    // In the form SDP, A writes and B reads, and the 36 bits of either are shared out over the pins of both.
    localparam WIDE = RAM_MODE == "SDP";
    wire [35:0] in_a = WIDE ? {DIPBDIP, DIPADIP, DIBDI, DIADI} : {2'd0, DIPADIP, 16'd0, DIADI};
    wire [35:0] in_b = {2'd0, DIPBDIP, 16'd0, DIBDI};
    wire [35:0] out_a, out_b;

    block_ram #(.BITS(13), .WIDTH_A(DATA_WIDTH_A), .WIDTH_B(DATA_WIDTH_B), .NEW_A(NEW_A), .NEW_B(NEW_B)) ram (
        .clk_a(CLKAWRCLK), .clk_b(CLKBRDCLK), .enable_a(ENAWREN), .enable_b(ENBRDEN),
        .write_a(WIDE ? {WEBWEU, WEAWEL} : {2'd0, WEAWEL}), .write_b(WIDE ? 4'd0 : {2'd0, WEBWEU}), .address_a(ADDRAWRADDR), .address_b(ADDRBRDADDR),
        .in_a(in_a), .in_b(in_b), .out_a(out_a), .out_b(out_b));

    assign {DOPADOP, DOADO} = WIDE ? {out_b[33:32], out_b[15:0]} : {out_a[33:32], out_a[15:0]};
    assign {DOPBDOP, DOBDO} = WIDE ? {out_b[35:34], out_b[31:16]} : {out_b[33:32], out_b[15:0]};

    initial
        if (DOA_REG != 0 || DOB_REG != 0 || !(NEW_A || WRITE_MODE_A == "READ_FIRST") || !(NEW_B || WRITE_MODE_B == "READ_FIRST")
            || (WIDE && DATA_WIDTH_A != 36)) begin
            $display("RAMB8BWER: a form without a model");
            $stop;
        end
endmodule

`default_nettype wire
