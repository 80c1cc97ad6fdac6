// Models of the ECP5 cells that yosys' library leaves empty, in the forms that synth_ecp5 makes of an inferred memory or product: a
// block RAM with ports of one width or an idle port B, the old word where a port reads and writes at once, no output register, no reset, contents and
// outputs that begin as 0; a product without registers. Other forms end the simulation. TO_Q: picoseconds from the clock to the word.
`default_nettype none
`timescale 1ps / 1ps

module block_ram #(
    parameter WIDTH = 36,
    parameter TO_Q = 0
) (
    input  wire        clk_a,
    input  wire        clk_b,
    input  wire        enable_a,
    input  wire        enable_b,
    input  wire [3:0]  write_a,          // lanes of nine bits
    input  wire [3:0]  write_b,
    input  wire [13:0] address_a,        // of a bit
    input  wire [13:0] address_b,
    input  wire [35:0] in_a,
    input  wire [35:0] in_b,
    output reg  [35:0] out_a,
    output reg  [35:0] out_b
);
    localparam SHIFT = WIDTH == 36 ? 5 : WIDTH == 18 ? 4 : WIDTH == 9 ? 3 : WIDTH == 4 ? 2 : WIDTH == 2 ? 1 : 0;

    integer    lane_a, lane_b, place;
    reg [35:0] words [0:(1 << (14 - SHIFT))-1];

    initial begin
        {out_a, out_b} = 72'd0;
        for (place = 0; place < 1 << (14 - SHIFT); place = place + 1) words[place] = 36'd0;
    end

    always @(posedge clk_a)
        if (enable_a) begin
            out_a <= #TO_Q words[address_a[13:SHIFT]];
            for (lane_a = 0; lane_a < 4; lane_a = lane_a + 1)
                if (write_a[lane_a]) words[address_a[13:SHIFT]][9*lane_a +: 9] <= in_a[9*lane_a +: 9];
        end

    always @(posedge clk_b)
        if (enable_b) begin
            out_b <= #TO_Q words[address_b[13:SHIFT]];
            for (lane_b = 0; lane_b < 4; lane_b = lane_b + 1)
                if (write_b[lane_b]) words[address_b[13:SHIFT]][9*lane_b +: 9] <= in_b[9*lane_b +: 9];
        end
endmodule

module DP16KD (
    input  wire DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13, DIA14, DIA15,
        DIA16, DIA17, DIB0, DIB1, DIB2, DIB3, DIB4, DIB5, DIB6, DIB7, DIB8, DIB9, DIB10, DIB11, DIB12, DIB13, DIB14,
        DIB15, DIB16, DIB17, ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
        ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13, CEA, OCEA, CLKA, WEA,
        RSTA, CSA0, CSA1, CSA2, CEB, OCEB, CLKB, WEB, RSTB, CSB0, CSB1, CSB2,
    output wire DOA0, DOA1, DOA2, DOA3, DOA4, DOA5, DOA6, DOA7, DOA8, DOA9, DOA10, DOA11, DOA12, DOA13, DOA14, DOA15,
        DOA16, DOA17, DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13, DOB14,
        DOB15, DOB16, DOB17
);
    parameter TO_Q = 0;
    parameter DATA_WIDTH_A = 18;
    parameter DATA_WIDTH_B = 18;
    parameter REGMODE_A = "NOREG";
    parameter REGMODE_B = "NOREG";
    parameter RESETMODE = "SYNC";
    parameter ASYNC_RESET_RELEASE = "SYNC";
    parameter CSDECODE_A = "0b000";
    parameter CSDECODE_B = "0b000";
    parameter WRITEMODE_A = "NORMAL";
    parameter WRITEMODE_B = "NORMAL";
    parameter CLKAMUX = "CLKA";
    parameter CLKBMUX = "CLKB";
    parameter GSR = "ENABLED";
    parameter [319:0] INITVAL_00 = 0, INITVAL_01 = 0, INITVAL_02 = 0, INITVAL_03 = 0;
    parameter [319:0] INITVAL_04 = 0, INITVAL_05 = 0, INITVAL_06 = 0, INITVAL_07 = 0;
    parameter [319:0] INITVAL_08 = 0, INITVAL_09 = 0, INITVAL_0A = 0, INITVAL_0B = 0;
    parameter [319:0] INITVAL_0C = 0, INITVAL_0D = 0, INITVAL_0E = 0, INITVAL_0F = 0;
    parameter [319:0] INITVAL_10 = 0, INITVAL_11 = 0, INITVAL_12 = 0, INITVAL_13 = 0;
    parameter [319:0] INITVAL_14 = 0, INITVAL_15 = 0, INITVAL_16 = 0, INITVAL_17 = 0;
    parameter [319:0] INITVAL_18 = 0, INITVAL_19 = 0, INITVAL_1A = 0, INITVAL_1B = 0;
    parameter [319:0] INITVAL_1C = 0, INITVAL_1D = 0, INITVAL_1E = 0, INITVAL_1F = 0;
    parameter [319:0] INITVAL_20 = 0, INITVAL_21 = 0, INITVAL_22 = 0, INITVAL_23 = 0;
    parameter [319:0] INITVAL_24 = 0, INITVAL_25 = 0, INITVAL_26 = 0, INITVAL_27 = 0;
    parameter [319:0] INITVAL_28 = 0, INITVAL_29 = 0, INITVAL_2A = 0, INITVAL_2B = 0;
    parameter [319:0] INITVAL_2C = 0, INITVAL_2D = 0, INITVAL_2E = 0, INITVAL_2F = 0;
    parameter [319:0] INITVAL_30 = 0, INITVAL_31 = 0, INITVAL_32 = 0, INITVAL_33 = 0;
    parameter [319:0] INITVAL_34 = 0, INITVAL_35 = 0, INITVAL_36 = 0, INITVAL_37 = 0;
    parameter [319:0] INITVAL_38 = 0, INITVAL_39 = 0, INITVAL_3A = 0, INITVAL_3B = 0;
    parameter [319:0] INITVAL_3C = 0, INITVAL_3D = 0, INITVAL_3E = 0, INITVAL_3F = 0;

    localparam WIDE = DATA_WIDTH_A == 36;            // both ports' pins make one word, which A writes and B reads

    wire [35:0] out_a, out_b;
    wire [13:0] address_a = {ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0};
    wire [13:0] address_b = {ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0};
    wire [17:0] in_a = {DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2,
        DIA1, DIA0};
    wire [17:0] in_b = {DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9, DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2,
        DIB1, DIB0};
    wire [3:0]  lanes_a = WIDE ? address_a[3:0] : DATA_WIDTH_A == 18 ? {2'b00, address_a[1:0]} : 4'b0001;
    wire [3:0]  lanes_b = DATA_WIDTH_B == 18 ? {2'b00, address_b[1:0]} : 4'b0001;

    block_ram #(.WIDTH(DATA_WIDTH_A), .TO_Q(TO_Q)) ram (
        .clk_a(CLKA), .clk_b(CLKB), .enable_a(CEA), .enable_b(CEB), .write_a(lanes_a & {4{WEA}}), .write_b(lanes_b & {4{WEB && !WIDE}}),
        .address_a(address_a), .address_b(address_b), .in_a({WIDE ? in_b : 18'd0, in_a}), .in_b({18'd0, in_b}), .out_a(out_a),
        .out_b(out_b));

    assign {DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2,
        DOA1, DOA0} = WIDE ? out_b[17:0] : out_a[17:0];
    assign {DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2,
        DOB1, DOB0} = WIDE ? out_b[35:18] : out_b[17:0];

    // The old word is what a port gives that writes, if anything reads it.
    wire known = (DATA_WIDTH_A == DATA_WIDTH_B || !CEB) && REGMODE_A == "NOREG" && REGMODE_B == "NOREG" && CSDECODE_A == "0b000"
        && CSDECODE_B == "0b000" && CLKAMUX == "CLKA" && CLKBMUX == "CLKB" && (WIDE || (WRITEMODE_A == "READBEFOREWRITE"
        && WRITEMODE_B == "READBEFOREWRITE"));

    always @(posedge CLKA)
        if (!known || RSTA || RSTB || CSA0 || CSA1 || CSA2 || CSB0 || CSB1 || CSB2 || !OCEB) begin
            $display("FAIL DP16KD: a form that ecp5_cells.v does not know");
            $finish;
        end
endmodule

module MULT18X18D (
    input  wire A0, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, A17, B0, B1, B2, B3, B4,
        B5, B6, B7, B8, B9, B10, B11, B12, B13, B14, B15, B16, B17, C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11,
        C12, C13, C14, C15, C16, C17, SIGNEDA, SIGNEDB, SOURCEA, SOURCEB, CLK0, CLK1, CLK2, CLK3, CE0, CE1, CE2, CE3,
        RST0, RST1, RST2, RST3,
    output wire P0, P1, P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P15, P16, P17, P18, P19, P20, P21,
        P22, P23, P24, P25, P26, P27, P28, P29, P30, P31, P32, P33, P34, P35
);
    parameter REG_INPUTA_CLK = "NONE";
    parameter REG_INPUTB_CLK = "NONE";
    parameter REG_INPUTC_CLK = "NONE";
    parameter REG_PIPELINE_CLK = "NONE";
    parameter REG_OUTPUT_CLK = "NONE";

    wire [17:0] a = {A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
    wire [17:0] b = {B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
    wire signed [35:0] product = $signed({SIGNEDA && a[17], a}) * $signed({SIGNEDB && b[17], b});

    assign {P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17, P16,
        P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0} = product;

    wire known = REG_INPUTA_CLK == "NONE" && REG_INPUTB_CLK == "NONE" && REG_PIPELINE_CLK == "NONE" && REG_OUTPUT_CLK == "NONE";

    always @(a or b)
        if (!known || SOURCEA || SOURCEB) begin
            $display("FAIL MULT18X18D: a form that ecp5_cells.v does not know");
            $finish;
        end
endmodule

`default_nettype wire
