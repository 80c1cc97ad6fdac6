// halfrow_fifo beside a plain list of the words inside it: no word is lost, doubled, changed or overtaken, and none waits for
// room that there is.
`default_nettype none

module fifo #(
    parameter BITS = 2
) (
    input wire       clk,
    input wire       wants_reset,
    input wire       in_valid,
    input wire [1:0] in_data,
    input wire       out_ready
);
    localparam MOST = 1 << BITS;             // in the memory and at the output

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running || wants_reset;

    wire            in_ready, out_valid;
    wire [1:0]      out_data;
    wire [BITS-1:0] used;
    halfrow_fifo #(.WIDTH(2), .BITS(BITS)) queue (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_data(in_data), .in_ready(in_ready),
        .out_valid(out_valid), .out_data(out_data), .out_ready(out_ready), .used(used));

    // The oldest word lies lowest.
    reg  [2*MOST+1:0] words;
    reg  [BITS:0]     count = 0;
    wire              goes_in = in_valid && in_ready;
    wire              goes_out = out_valid && out_ready;
    wire [BITS:0]     left = count - goes_out;
    wire [2*MOST+1:0] behind = goes_out ? words >> 2 : words;

    always @(posedge clk)
        if (rst)
            count <= 0;
        else begin
            count <= left + goes_in;
            words <= goes_in ? (behind & ~(2'd3 << 2 * left)) | (in_data << 2 * left) : behind;
        end

    reg nothing_shown = 1'b0;                // though there was a word inside
    always @(posedge clk) nothing_shown <= !rst && count != 0 && !out_valid;

    always @(posedge clk)
        if (running && !rst) begin
            holds: assert (count <= MOST && count == used + out_valid);
            in_order: assert (!out_valid || (count != 0 && out_data == words[1:0]));
            takes: assert (in_ready || count >= MOST);
            gives: assert (!nothing_shown || out_valid);
        end
endmodule

`default_nettype wire
