// halfrow_async_fifo with two clocks that rise whenever they like, beside a plain list: no word is lost, doubled, changed or
// overtaken, one that is there is offered and one for which there is room is taken, and of a pointer that crosses no two bits change at once.
`default_nettype none

module async_fifo #(
    parameter BITS = 2
) (
    input wire in_clk,
    input wire out_clk,
    input wire in_valid,
    input wire in_data,
    input wire out_ready
);
    localparam MOST = (1 << BITS) + 1;       // in the memory and at the output

    (* gclk *) wire step;                    // of the solver; an edge takes what stood before it

    wire          in_ready, out_valid, out_data;
    wire [BITS:0] head_gray, tail_gray;
    reg           rst = 1'b1;
    halfrow_async_fifo queue (
        .in_clk(in_clk), .in_rst(rst), .in_valid(in_valid), .in_data(in_data), .in_ready(in_ready),
        .out_clk(out_clk), .out_rst(rst), .out_valid(out_valid), .out_data(out_data), .out_ready(out_ready),
        .head_gray(head_gray), .tail_gray(tail_gray));

    reg               in_was = 1'b1, out_was = 1'b1;
    reg               in_seen = 1'b0, out_seen = 1'b0, watched = 1'b0;
    wire              in_rises = in_clk && !in_was;
    wire              out_rises = out_clk && !out_was;
    reg               goes_in_next, goes_out_next, data_next;

    // With the edges of this step; the oldest word lies lowest.
    reg  [MOST:0]     words;
    reg  [BITS+1:0]   count = 0;
    wire              goes_in = watched && in_rises && goes_in_next;
    wire              goes_out = watched && out_rises && goes_out_next;
    wire [BITS+1:0]   left = count - goes_out;
    wire [BITS+1:0]   count_now = left + goes_in;
    wire [MOST:0]     behind = goes_out ? words >> 1 : words;
    wire [MOST:0]     words_now = goes_in ? (behind & ~(1'b1 << left)) | (data_next << left) : behind;
    reg  [BITS:0]     head_was, tail_was;
    // Edges of each side since the other side's pointer has moved, from which on it has had the time to know.
    reg  [1:0]        in_edges = 2'd0, out_edges = 2'd0;
    wire [BITS:0]     head_moved = head_was ^ head_gray, tail_moved = tail_was ^ tail_gray;

    always @(posedge step) begin
        in_was <= in_clk;
        out_was <= out_clk;
        in_seen <= in_seen || in_rises;
        out_seen <= out_seen || out_rises;
        rst <= !(in_seen && out_seen);       // each side has had an edge in it
        watched <= !rst;
        {goes_in_next, goes_out_next, data_next} <= {in_valid && in_ready, out_valid && out_ready, in_data};
        in_edges <= !watched || goes_out ? 2'd0 : in_edges + (in_rises && !(&in_edges));
        out_edges <= !watched || goes_in ? 2'd0 : out_edges + (out_rises && !(&out_edges));
        count <= count_now;
        words <= words_now;
        head_was <= head_gray;
        tail_was <= tail_gray;
    end

    always @(posedge step)
        if (watched) begin
            holds: assert (count_now <= MOST);
            in_order: assert (!out_valid || (count_now != 0 && out_data == words_now[0]));
            takes: assert (in_ready || goes_out || in_edges < 3 || count_now >= (1 << BITS));
            gives: assert (out_valid || goes_in || out_edges < 3 || count_now == 0);
            head_is_gray: assert ((head_moved & (head_moved - 1'b1)) == 0);
            tail_is_gray: assert ((tail_moved & (tail_moved - 1'b1)) == 0);
        end
endmodule

`default_nettype wire
