// What CONFIGURE sets, and which of its fields a build cannot have.
`default_nettype none

module halfrow_settings #(
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter LEAST_BLANKING = 0,
    parameter POWER_UP_WIDTH = MAX_WIDTH,
    parameter POWER_UP_HEIGHT = MAX_HEIGHT
) (
    input  wire         clk,
    input  wire         restore,      // pulse: the settings of power-up, no configuration
    input  wire [103:0] wanted,       // the payload of CONFIGURE, its first byte in [7:0]
    input  wire         load,         // pulse: take it; stable for two clocks before
    output reg          out_of_range, // of what is wanted
    output reg  [2:0]   wrong_field,
    output reg          configured,
    output reg  [11:0]  width,
    output reg  [11:0]  height,
    output reg  [12:0]  centre2,      // C, twice the optical centre's column
    output reg  [15:0]  blanking,
    output reg  [31:0]  gap_seed,
    output reg  [1:0]   depth         // 0: 8 bits, 1: 10, 2: 12
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (MAX_WIDTH < LEAST_WIDTH || MAX_WIDTH > GREATEST_WIDTH || MAX_WIDTH % 2 != 0)
            halfrow_illegal_MAX_WIDTH is_even_and_64_to_2592 ();
        if (MAX_HEIGHT < 1 || MAX_HEIGHT > GREATEST_HEIGHT) halfrow_illegal_MAX_HEIGHT is_1_to_2048 ();
        if (LEAST_BLANKING < 0 || LEAST_BLANKING > 65535) halfrow_illegal_LEAST_BLANKING is_0_to_65535 ();
        if (POWER_UP_WIDTH != MAX_WIDTH
            && (POWER_UP_WIDTH < LEAST_WIDTH || POWER_UP_WIDTH > MAX_WIDTH || POWER_UP_WIDTH % 2 != 0))
            halfrow_illegal_POWER_UP_WIDTH is_even_and_64_to_MAX_WIDTH ();
        if (POWER_UP_HEIGHT != MAX_HEIGHT && (POWER_UP_HEIGHT < 1 || POWER_UP_HEIGHT > MAX_HEIGHT))
            halfrow_illegal_POWER_UP_HEIGHT is_1_to_MAX_HEIGHT ();
    endgenerate

    localparam [12:0] POWER_UP_CENTRE2 = POWER_UP_WIDTH[12:0] - 13'd1;
    localparam [15:0] POWER_UP_BLANKING = LEAST_BLANKING[15:0];
    localparam [1:0] POWER_UP_DEPTH = DEPTH_12;

    wire [15:0] new_width = wanted[15:0];
    wire [15:0] new_height = wanted[31:16];
    wire [15:0] new_centre2 = wanted[47:32];
    wire [15:0] new_blanking = wanted[63:48];
    wire [31:0] new_gap_seed = wanted[95:64];
    wire [7:0] new_bits = wanted[103:96];

    reg [16:0] least_width2;
    reg bits_wrong, width_wrong, height_wrong, blanking_wrong;
    wire centre_wrong = {new_width, 1'b0} < least_width2;
    wire [16:0] above_blanking = {1'b0, new_blanking} - {1'b0, POWER_UP_BLANKING};
    wire unused = &{1'b0, above_blanking[15:0]};

    always @(posedge clk) begin
        bits_wrong <= new_bits != 8'd8 && new_bits != 8'd10 && new_bits != 8'd12;
        width_wrong <= new_width[0] || new_width < LEAST_WIDTH || {16'd0, new_width} > MAX_WIDTH;
        height_wrong <= new_height == 16'd0 || {16'd0, new_height} > MAX_HEIGHT;
        blanking_wrong <= above_blanking[16];
        least_width2 <= {1'b0, new_centre2} + 17'd2;
        out_of_range <= bits_wrong || width_wrong || height_wrong || centre_wrong || blanking_wrong;
        wrong_field <= bits_wrong ? 3'd5 : width_wrong ? 3'd0 : height_wrong ? 3'd1 : centre_wrong ? 3'd2 : 3'd3;
    end

    always @(posedge clk) begin
        if (restore) begin
            configured <= 1'b0;
            width <= POWER_UP_WIDTH[11:0];
            height <= POWER_UP_HEIGHT[11:0];
            centre2 <= POWER_UP_CENTRE2;
            blanking <= POWER_UP_BLANKING;
            gap_seed <= 32'd0;
            depth <= POWER_UP_DEPTH;
        end else if (load) begin
            configured <= 1'b1;
            width <= new_width[11:0];
            height <= new_height[11:0];
            centre2 <= new_centre2[12:0];
            blanking <= new_blanking;
            gap_seed <= new_gap_seed;
            depth <= new_bits[2:1];
        end
    end
endmodule

`default_nettype wire
