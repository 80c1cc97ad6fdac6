// The weighted sum of the taps, G2 * 2^14 + g0 (G0 - G2) + g4 (G4 - G2) + g6 (G6 - G2) + r1 (R1 - R3) + r5 (R5 - R3),
// rounded and clamped. One adder stands between two registers: the products are added one after the other, so taps
// and weights wait for their turn.
`default_nettype none

module halfrow_weigh #(
    parameter TAPS = 7
) (
    input  wire        clk,
    input  wire        rst,
    input  wire        enable,
    input  wire [1:0]  depth,
    input  wire [83:0] taps,       // G0 R1 G2 R3 G4 R5 G6, G0 lowest
    input  wire [79:0] weights,    // {g6, r5, g4, r1, g0}, one enabled clock behind the taps
    input  wire        made_valid, // with the taps
    input  wire        made_start,
    input  wire        made_last,
    output wire        out_valid,
    output wire        out_start,
    output wire        out_last,
    output reg  [11:0] out_sample
);
    localparam STAGES = (TAPS == 7) ? 7 : 6;

    wire [11:0] g0 = taps[11:0], r1 = taps[23:12], g2 = taps[35:24], r3 = taps[47:36], g4 = taps[59:48];
    wire [11:0] r5 = taps[71:60], g6 = taps[83:72];
    wire [15:0] weight_g4 = weights[47:32];

    reg [11:0] g2_1, r1_1, r3_1, r5_1, g2_2, r3_2, r5_2;
    reg [15:0] weight_r1_1, weight_r5_1, weight_r5_2;
    always @(posedge clk)
        if (enable) begin
            {r1_1, g2_1, r3_1, r5_1} <= {r1, g2, r3, r5};
            {g2_2, r3_2, r5_2} <= {g2_1, r3_1, r5_1};
            {weight_r1_1, weight_r5_1} <= {weights[31:16], weights[63:48]};
            weight_r5_2 <= weight_r5_1;
        end

    wire signed [47:0] sum_g4, sum_r1, sum_r5;
    wire signed [33:0] acc;

    halfrow_multiply_add #(.BITS(13), .DIFFERENCE_BITS(13)) weigh_g4 (
        .clk(clk), .enable(enable), .minuend({1'b0, g4}), .subtrahend({1'b0, g2}),
        .factor(weight_g4), .addend({22'd0, g2_2, 14'h2000}), .sum(sum_g4));
    halfrow_multiply_add #(.BITS(13), .DIFFERENCE_BITS(13)) weigh_r1 (
        .clk(clk), .enable(enable), .minuend({1'b0, r1_1}), .subtrahend({1'b0, r3_1}),
        .factor(weight_r1_1), .addend(sum_g4), .sum(sum_r1));
    halfrow_multiply_add #(.BITS(13), .DIFFERENCE_BITS(13)) weigh_r5 (
        .clk(clk), .enable(enable), .minuend({1'b0, r5_2}), .subtrahend({1'b0, r3_2}),
        .factor(weight_r5_2), .addend(sum_r1), .sum(sum_r5));

    generate
        if (TAPS == 7) begin : outer
            reg [11:0] g0_1, g6_1, g6_2;
            reg [15:0] weight_g0_1, weight_g6_1, weight_g6_2;
            always @(posedge clk)
                if (enable) begin
                    {g0_1, g6_1, g6_2} <= {g0, g6, g6_1};
                    {weight_g0_1, weight_g6_1, weight_g6_2} <= {weights[15:0], weights[79:64], weight_g6_1};
                end

            wire signed [47:0] sum_g0, sum_g6;
            reg signed [33:0] sum_all;

            halfrow_multiply_add #(.BITS(13), .DIFFERENCE_BITS(13)) weigh_g0 (
                .clk(clk), .enable(enable), .minuend({1'b0, g0_1}), .subtrahend({1'b0, g2_1}),
                .factor(weight_g0_1), .addend(48'd0), .sum(sum_g0));
            halfrow_multiply_add #(.BITS(13), .DIFFERENCE_BITS(13)) weigh_g6 (
                .clk(clk), .enable(enable), .minuend({1'b0, g6_2}), .subtrahend({1'b0, g2_2}),
                .factor(weight_g6_2), .addend(sum_g0), .sum(sum_g6));
            always @(posedge clk)
                if (enable)
                    sum_all <= sum_r5[33:0] + sum_g6[33:0];
            assign acc = sum_all;
            wire unused = &{1'b0, sum_r5[47:34], sum_g6[47:34]};
        end else begin : inner
            assign acc = sum_r5[33:0];
            wire unused = &{1'b0, g0, g6, weights[79:64], weights[15:0], sum_r5[47:34]};
        end
    endgenerate

    wire negative = acc[33];
    wire [1:0] missing = 2'd2 - depth; // pairs of bits that a sample of 12 has and one of this depth does not
    wire over = |acc[32:26] || (|missing && |acc[25:24]) || (missing[1] && |acc[23:22]);
    wire [11:0] largest = 12'hfff >> {missing, 1'b0};

    always @(posedge clk)
        if (enable)
            out_sample <= negative ? 12'd0 : over ? largest : acc[25:14];
    wire unused_fraction = &{1'b0, acc[13:0]};

    reg [STAGES-1:0] valids, starts, lasts;
    always @(posedge clk)
        if (rst)
            valids <= {STAGES{1'b0}};
        else if (enable)
            valids <= {valids[STAGES-2:0], made_valid};
    always @(posedge clk)
        if (enable) begin
            starts <= {starts[STAGES-2:0], made_start};
            lasts <= {lasts[STAGES-2:0], made_last};
        end

    assign out_valid = valids[STAGES-1];
    assign out_start = starts[STAGES-1];
    assign out_last = lasts[STAGES-1];
endmodule

`default_nettype wire
