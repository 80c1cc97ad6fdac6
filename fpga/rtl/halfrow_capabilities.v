// The payload of the reply to CAPABILITIES, byte by byte: what the build is, from its parameters.
`default_nettype none

module halfrow_capabilities #(
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter TAPS = 7,
    parameter LATENCY = 12,                // L
    parameter RING_BITS = 11,              // M = 2 ** RING_BITS
    parameter LEAST_BLANKING = 0,
    parameter TABLE_BANKS = 2,
    parameter ROW_BANKS_IN = 2,
    parameter ROW_BANKS_OUT = 2,
    parameter NATURE = 1,                  // 1: hardware, 2: simulation
    parameter NAME_LENGTH = 7,             // bytes, 1 to 68
    parameter [8*NAME_LENGTH-1:0] NAME = "halfrow"
) (
    input  wire [ 7:0] clock_source,       // 0: the host's own, 1: PIXCLK, 2: a PLL
    input  wire [31:0] clock_hz,           // 0 when it is not known
    input  wire [ 6:0] index,
    output wire [ 7:0] value,
    output wire [ 6:0] length              // bytes
);
    localparam DATAPATH     = 1;
    localparam DEPTHS       = 7;           // 8, 10 and 12 bits
    localparam STEP_PORTS   = 1;
    localparam KERNEL_PORTS = 2;

    localparam FIXED = 58;
    localparam TOTAL = FIXED + NAME_LENGTH;

    localparam [15:0] DATAPATH_16       = DATAPATH[15:0];
    localparam [15:0] MAX_WIDTH_16      = MAX_WIDTH[15:0];
    localparam [15:0] MAX_HEIGHT_16     = MAX_HEIGHT[15:0];
    localparam [ 7:0] DEPTHS_8          = DEPTHS[7:0];
    localparam [ 7:0] TAPS_8            = TAPS[7:0];
    localparam [ 7:0] LATENCY_8         = LATENCY[7:0];
    localparam [15:0] RING_16           = 1 << RING_BITS;
    localparam [15:0] LEAST_BLANKING_16 = LEAST_BLANKING[15:0];
    localparam [ 7:0] TABLE_BANKS_8     = TABLE_BANKS[7:0];
    localparam [ 7:0] ROW_BANKS_IN_8    = ROW_BANKS_IN[7:0];
    localparam [ 7:0] ROW_BANKS_OUT_8   = ROW_BANKS_OUT[7:0];
    localparam [ 7:0] STEP_PORTS_8      = STEP_PORTS[7:0];
    localparam [ 7:0] KERNEL_PORTS_8    = KERNEL_PORTS[7:0];
    localparam [ 7:0] NATURE_8          = NATURE[7:0];
    localparam [ 7:0] NAME_LENGTH_8     = NAME_LENGTH[7:0];

    // {value, length, tag}, the first byte to go in [7:0]
    wire [1023:0] list;
    assign list[8*FIXED-1:0] = {
        NAME_LENGTH_8, 8'h21,
        NATURE_8, 8'd1, 8'h20,
        clock_hz, 8'd4, 8'h0f,
        clock_source, 8'd1, 8'h0e,
        KERNEL_PORTS_8, 8'd1, 8'h0d,
        STEP_PORTS_8, 8'd1, 8'h0c,
        ROW_BANKS_OUT_8, 8'd1, 8'h0b,
        ROW_BANKS_IN_8, 8'd1, 8'h0a,
        TABLE_BANKS_8, 8'd1, 8'h09,
        LEAST_BLANKING_16, 8'd2, 8'h08,
        RING_16, 8'd2, 8'h07,
        LATENCY_8, 8'd1, 8'h06,
        TAPS_8, 8'd1, 8'h05,
        DEPTHS_8, 8'd1, 8'h04,
        MAX_HEIGHT_16, 8'd2, 8'h03,
        MAX_WIDTH_16, 8'd2, 8'h02,
        DATAPATH_16, 8'd2, 8'h01
    };

    genvar i;
    generate
        for (i = 0; i < NAME_LENGTH; i = i + 1) begin : character
            assign list[8*(FIXED+i) +: 8] = NAME[8*(NAME_LENGTH-1-i) +: 8];
        end
    endgenerate
    assign list[1023:8*TOTAL] = {(1024-8*TOTAL){1'b0}};

    assign value  = list[{index, 3'b000} +: 8];
    assign length = TOTAL;
endmodule

`default_nettype wire
