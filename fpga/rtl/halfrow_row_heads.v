// What stands between a row's place and its samples in a ROW_OUT packet, bytes 8 to 19 of the payload, for each out-bank. The
// bytes come from three sides and are written one by one.
`default_nettype none

module halfrow_row_heads #(
    parameter OUT_BITS = 1
) (
    input  wire                clk,
    input  wire                rst,

    input  wire                start,          // pulse; of the fields that follow all but the bank stay for 8 clocks
    input  wire [OUT_BITS-1:0] start_bank,
    input  wire [11:0]         width,
    input  wire                start_is_last,
    input  wire [7:0]          start_generation,

    input  wire                left,           // pulse; the fields that follow stay for 16 clocks
    input  wire [OUT_BITS-1:0] left_bank,
    input  wire [15:0]         first_latency,
    input  wire [15:0]         last_latency,
    input  wire [15:0]         pauses,

    input  wire [OUT_BITS-1:0] bank,
    input  wire [3:0]          index,          // byte 8 to 19, modulo 16
    output wire [7:0]          value,
    input  wire                replace,        // pulse: by `replacement`
    input  wire [7:0]          replacement
);
    (* ram_style = "distributed" *) reg [7:0] bytes [0:(16<<OUT_BITS)-1];

    reg                start_due, left_due;
    reg [1:0]          start_place;
    reg [2:0]          left_place;
    reg [OUT_BITS-1:0] started_bank;
    reg [7:0]          start_byte, left_byte;

    always @* begin
        case (start_place)
            2'd0:    start_byte = width[7:0];
            2'd1:    start_byte = {4'd0, width[11:8]};
            2'd2:    start_byte = {7'd0, start_is_last};
            default: start_byte = start_generation;
        endcase
        case (left_place)
            3'd0:    left_byte = first_latency[7:0];
            3'd1:    left_byte = first_latency[15:8];
            3'd2:    left_byte = last_latency[7:0];
            3'd3:    left_byte = last_latency[15:8];
            3'd4:    left_byte = pauses[7:0];
            default: left_byte = pauses[15:8];
        endcase
    end

    wire [OUT_BITS+3:0] place = {bank, index};
    wire [OUT_BITS+3:0] started_at = {started_bank, 2'b10, start_place};
    wire [OUT_BITS+3:0] left_at = {left_bank, {2{!left_place[2]}}, left_place[1:0]};
    wire [OUT_BITS+3:0] address = replace ? place : start_due ? started_at : left_at;

    assign value = bytes[place];

    always @(posedge clk)
        if (replace || start_due || left_due)
            bytes[address] <= replace ? replacement : start_due ? start_byte : left_byte;

    always @(posedge clk) begin
        if (start) begin
            started_bank <= start_bank;
            start_place <= 2'd0;
        end else if (start_due && !replace)
            start_place <= start_place + 2'd1;
        if (left)
            left_place <= 3'd0;
        else if (left_due && !start_due && !replace)
            left_place <= left_place + 3'd1;
        start_due <= !rst && (start || (start_due && (replace || start_place != 2'd3)));
        left_due <= !rst && (left || (left_due && (start_due || replace || left_place != 3'd5)));
    end
endmodule

`default_nettype wire
